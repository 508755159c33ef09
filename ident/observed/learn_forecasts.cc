// ident: trials of both forecasters, and what is learned from them.
#include "ident/observed/learn_forecasts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "ident/problem/parallel.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

// s after frame 0.
constexpr double kMoments[] = {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr int kFramesAfter = 5;                                 // at least
constexpr double kInputTimes[] = {0.15, 0.0, 0.075, 0.3, 0.6};  // s; of equal ones the first
constexpr double kLeastError = 1e-3;                            // m
constexpr size_t kFewestErrors = 100;

std::vector<ForecastTrial> TrialsOf(const IdentifiedModel& model,
                                    const PendulumRecording& recording) {
  std::vector<ForecastTrial> trials;
  const int frames = recording.num_frames();
  const HipPaths rollout = HipsOfRollout(model, recording, frames);
  for (size_t i = 0; i < std::size(kTails); ++i) {
    FirstFrames first(model, kTails[i], recording, rollout, frames);
    size_t moment = 0;
    for (int t = 0; t + kFramesAfter < frames && moment < std::size(kMoments); ++t) {
      if (t > 0) first.Observe(FrameAt(recording, t));
      if (first.seconds() < kMoments[moment] - 1e-9) continue;
      TwoForecasts two = first.Forecasts();
      if (i == 0) {
        ForecastTrial& trial = trials.emplace_back();
        trial.seconds = first.seconds();
        trial.dt = recording.scene.dt;
        trial.axes = PushAxes(recording);
        trial.physics = std::move(two.physics);
        trial.from = first.LastHips();
        for (int n = 0; n < recording.num_people(); ++n) {
          trial.measured.emplace_back(recording.hip[n].begin() + t + 1, recording.hip[n].end());
          trial.seen.emplace_back();
          for (int u = t + 1; u < frames; ++u)
            trial.seen[n].push_back(recording.Weight(n, u) > 0.0);
        }
      }
      trials[moment++].input[i] = std::move(two.input);
    }
  }
  return trials;
}

HipPaths BlendedBy(const ForecastRule& rule, const ForecastTrial& trial) {
  const size_t tail = std::find(std::begin(kTails), std::end(kTails), rule.tail) - kTails;
  const HipPaths& input = trial.input[tail];
  const auto share = InputShare(rule.input_time, trial.physics, input, trial.seconds);
  return share ? Blended(*share, trial.physics, input) : HipPaths();
}

// Every fold's forecasts by a rule that was learned without it.
std::vector<HipPaths> NestedForecasts(const std::vector<ForecastTrial>& trials, int folds) {
  std::vector<HipPaths> centre(trials.size());
  for (int f = 0; f < std::max(1, folds); ++f) {
    const ForecastRule rule = folds > 0 ? LearnRule(trials, f) : ForecastRule();
    for (size_t i = 0; i < trials.size(); ++i) {
      if (trials[i].fold == f) centre[i] = BlendedBy(rule, trials[i]);
    }
  }
  return centre;
}

// A hip some frames ahead, on the axes of the push. A trial counts once, however many frames it
// has: so does a recording in the share of its frames that a band holds.
struct ScaledError {
  Eigen::Vector4d features;
  Vector3<double> off;
  double weight;
};

void AddErrors(const ForecastTrial& trial, const HipPaths& centre,
               std::vector<ScaledError>* errors) {
  const size_t before = errors->size();
  for (size_t n = 0; n < centre.size(); ++n) {
    for (size_t t = 0; t < centre[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      const double ahead = (static_cast<double>(t) + 1.0) * trial.dt;
      const double speed = (centre[n][t] - trial.from[n]).norm() / ahead;
      errors->push_back({ScaleFeatures(ahead, trial.seconds, speed),
                         trial.axes.transpose() * (trial.measured[n][t] - centre[n][t]), 0.0});
    }
  }
  for (size_t i = before; i < errors->size(); ++i) {
    (*errors)[i].weight = 1.0 / static_cast<double>(errors->size() - before);
  }
}

std::vector<double> WeightedQuantiles(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double total = 0.0, below = 0.0;
  for (const auto& [value, weight] : values) total += weight;
  std::vector<double> quantiles;
  size_t at = 0;
  for (double share : kErrorShares) {
    while (at + 1 < values.size() && below + values[at].second < share * total) {
      below += values[at++].second;
    }
    quantiles.push_back(std::max(1e-9, values[at].first));
  }
  return quantiles;
}

// Over people and frames that were seen; none where there are none.
std::optional<double> MeanDistance(const ForecastTrial& trial, const HipPaths& hips) {
  double sum = 0.0, count = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 0; t < hips[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      sum += (hips[n][t] - trial.measured[n][t]).norm();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional<double>(sum / count) : std::nullopt;
}

}  // namespace

ForecastRule LearnRule(const std::vector<ForecastTrial>& trials, int left_out) {
  ForecastRule best;
  double least = HUGE_VAL;
  for (double tail : kTails) {
    for (double time : kInputTimes) {
      ForecastRule rule;
      rule.tail = tail, rule.input_time = time;
      double sum = 0.0;
      for (const ForecastTrial& trial : trials) {
        if (trial.fold != left_out)
          sum += MeanDistance(trial, BlendedBy(rule, trial)).value_or(0.0);
      }
      if (sum < least) least = sum, best = rule;
    }
  }
  return best;
}

std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre) {
  std::array<ErrorScale, 3> scales;
  std::vector<ScaledError> errors;
  for (size_t i = 0; i < trials.size(); ++i) AddErrors(trials[i], centre[i], &errors);
  if (errors.size() < kFewestErrors) return scales;
  Eigen::Matrix4d gram = 1e-6 * Eigen::Matrix4d::Identity();
  for (const ScaledError& e : errors) gram += e.weight * e.features * e.features.transpose();
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const ScaledError& e : errors) {
      right += e.weight * std::log(std::max(kLeastError, std::abs(e.off[axis]))) * e.features;
    }
    ErrorScale& scale = scales[axis];
    scale.coefficients = SolveSymmetric(Eigen::MatrixXd(gram), Eigen::VectorXd(right));
    std::vector<std::pair<double, double>> over;  // and the weight
    for (const ScaledError& e : errors) {
      over.emplace_back(std::abs(e.off[axis]) / std::exp(scale.coefficients.dot(e.features)),
                        e.weight);
    }
    scale.quantiles = WeightedQuantiles(std::move(over));
  }
  return scales;
}

std::optional<ForecastRule> LearnForecasts(const IdentifiedModel& model,
                                           const std::vector<PendulumRecording>& recordings,
                                           const std::vector<FoldModel>& folds, int num_threads) {
  // The models that forecast: those of the folds, or the model itself.
  std::vector<FoldModel> forecasters = folds;
  if (folds.empty()) {
    forecasters.push_back({model, std::vector<int>(recordings.size())});
    std::iota(forecasters[0].held_out.begin(), forecasters[0].held_out.end(), 0);
  }
  std::vector<ForecastTrial> trials;
  for (size_t f = 0; f < forecasters.size(); ++f) {
    const FoldModel& fold = forecasters[f];
    std::vector<std::vector<ForecastTrial>> made(fold.held_out.size());
    ParallelFor(static_cast<int>(made.size()), num_threads, [&](int i) {
      made[i] = TrialsOf(fold.model, recordings[fold.held_out[i]]);
      for (ForecastTrial& trial : made[i]) {
        trial.fold = static_cast<int>(f), trial.recording = fold.held_out[i];
      }
    });
    for (auto& of_recording : made) {
      for (ForecastTrial& trial : of_recording) {
        if (!trial.physics.empty() || !trial.input[0].empty()) trials.push_back(std::move(trial));
      }
    }
  }
  if (trials.empty()) return std::nullopt;
  ForecastRule rule = folds.empty() ? ForecastRule() : LearnRule(trials);
  std::set<int> forecast;
  for (const ForecastTrial& trial : trials) forecast.insert(trial.recording);
  rule.folds = static_cast<int>(folds.size());
  rule.recordings = static_cast<int>(forecast.size());
  rule.errors = LearnErrorScales(trials, NestedForecasts(trials, rule.folds));
  return rule;
}

}  // namespace pushid
