// ident: trials of both forecasters, and what is learned from them.
#include "ident/observed/learn_forecasts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "ident/problem/parallel.h"
#include "models/decompositions.h"
#include "models/rollout.h"

namespace pushid {
namespace {

// The filter's numbers: a grid of tails and force times, judged by forecasts.
constexpr double kTailStrengths[] = {1.0, 1.5, 2.2}, kTailTimes[] = {1.0, 1.5, 2.2};
constexpr double kForceTimes[] = {0.06, 0.1, 0.2};           // s
constexpr double kChoiceMoments[] = {0.2, 0.33, 0.5, 0.75};  // s after frame 0
constexpr int kChoiceFramesAfter = 5;                        // at least
constexpr size_t kMostRecordings = 24;

std::vector<ForecastRule> Candidates() {
  std::vector<ForecastRule> candidates;
  for (double strength : kTailStrengths) {
    for (double time : kTailTimes) {
      for (double seconds : kForceTimes) {
        ForecastRule& candidate = candidates.emplace_back();
        candidate.tail_strength = strength, candidate.tail_time = time;
        candidate.noise.force_time = seconds;
      }
    }
  }
  return candidates;
}

// The mean distance of the filter's forecasts, m; those that fail count as where nobody moves.
double InputError(const IdentifiedModel& model, const ForecastRule& stack,
                  const PendulumRecording& recording) {
  const int frames = recording.num_frames();
  std::optional<SceneFilter> filter = ForecastFilter(model, stack, recording, frames);
  double sum = 0.0, count = 0.0;
  size_t next = 0;
  for (int t = 1; t + kChoiceFramesAfter < frames && next < std::size(kChoiceMoments); ++t) {
    const SeenFrame frame = FrameAt(recording, t);
    filter->Observe(frame.states, frame.hips.seen);
    if (t * recording.scene.dt < kChoiceMoments[next] - 1e-9) continue;
    ++next;
    RolloutPath<double> path;
    const bool ok = filter->Forecast(&path).ok;
    for (int n = 0; n < recording.num_people(); ++n) {
      const Body& body = recording.scene.people[n].body;
      const Vector3<double> here = recording.hip[n][t];
      const auto moved = [&](int u) -> Vector3<double> {
        if (!ok) return here;
        return here + HipPosition(body, path.At(u, n).q) - HipPosition(body, path.At(t, n).q);
      };
      for (int u = t + 1; u < frames; u += 3) {
        sum += recording.Weight(n, u) * (recording.hip[n][u] - moved(u)).norm();
        count += recording.Weight(n, u);
      }
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

// Some recordings of each fold, evenly.
std::vector<std::pair<int, int>> Judged(const std::vector<FoldModel>& folds) {
  std::vector<std::pair<int, int>> all;  // fold and recording
  for (size_t f = 0; f < folds.size(); ++f) {
    for (int i : folds[f].held_out) all.emplace_back(static_cast<int>(f), i);
  }
  const size_t step = std::max<size_t>(1, (all.size() + kMostRecordings - 1) / kMostRecordings);
  std::vector<std::pair<int, int>> some;
  for (size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

// The numbers of the filter of unknown forces that forecast best: of each fold by how the other
// folds are forecast, each by the model fitted without it; last, by all of them.
std::vector<ForecastRule> ChooseInputs(const std::vector<PendulumRecording>& recordings,
                                       const std::vector<FoldModel>& folds, int num_threads) {
  const std::vector<ForecastRule> candidates = Candidates();
  std::vector<ForecastRule> chosen(folds.size() + 1);
  if (folds.empty() || folds[0].model.options.learned != nullptr) return chosen;
  const std::vector<std::pair<int, int>> judged = Judged(folds);
  std::vector<std::vector<double>> errors(judged.size());
  ParallelFor(static_cast<int>(judged.size()), num_threads, [&](int k) {
    const auto& [fold, recording] = judged[k];
    for (const ForecastRule& candidate : candidates) {
      errors[k].push_back(InputError(folds[fold].model, candidate, recordings[recording]));
    }
  });
  for (size_t f = 0; f < chosen.size(); ++f) {
    std::vector<double> sums(candidates.size(), 0.0);
    for (size_t k = 0; k < judged.size(); ++k) {
      if (judged[k].first == static_cast<int>(f)) continue;
      for (size_t c = 0; c < sums.size(); ++c) sums[c] += errors[k][c];
    }
    chosen[f] = candidates[std::min_element(sums.begin(), sums.end()) - sums.begin()];
  }
  return chosen;
}

// s after frame 0.
constexpr double kMoments[] = {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr int kFramesAfter = 5;  // at least
constexpr double kInputShares[] = {0.6, 0.0, 0.2, 0.4, 0.8, 1.0};
constexpr double kLeastError = 1e-3;  // m
constexpr size_t kFewestErrors = 100;

ForecastTrial MakeTrial(const PendulumRecording& recording, const FirstFrames& frames,
                        const HipPaths& rollout) {
  ForecastTrial trial;
  trial.seconds = frames.seconds();
  trial.dt = recording.scene.dt;
  trial.axes = frames.filter().Axes();
  TwoForecasts two = frames.Forecasts(rollout);
  trial.physics = std::move(two.physics), trial.input = std::move(two.input);
  trial.from = frames.LastHips();
  const int observed = frames.observed();
  for (int n = 0; n < recording.num_people(); ++n) {
    const auto& hip = recording.hip[n];
    trial.measured.emplace_back(hip.begin() + observed, hip.end());
    trial.seen.emplace_back();
    for (int t = observed; t < recording.num_frames(); ++t) {
      trial.seen[n].push_back(recording.Weight(n, t) > 0.0);
    }
  }
  return trial;
}

std::vector<ForecastTrial> TrialsOf(const IdentifiedModel& model, const ForecastRule& rule,
                                    const PendulumRecording& recording) {
  std::vector<ForecastTrial> trials;
  const int frames = recording.num_frames();
  FirstFrames first(model, rule, recording, frames);
  size_t moment = 0;
  for (int t = 0; t + kFramesAfter < frames; ++t) {
    if (t > 0) first.Observe(FrameAt(recording, t));
    if (first.seconds() < kMoments[moment] - 1e-9) continue;
    const double effect = first.filter().Effect(*model.recording_effect).mean;
    const HipPaths rollout = HipsOfRollouts(model, recording, {effect}, frames).front();
    trials.push_back(MakeTrial(recording, first, rollout));
    if (++moment == std::size(kMoments)) break;
  }
  return trials;
}

HipPaths BlendedBy(double input_share, const ForecastTrial& trial) {
  const auto share = InputShare(input_share, trial.physics, trial.input, trial.seconds);
  return share ? Blended(*share, trial.physics, trial.input) : HipPaths();
}

// Every fold's forecasts with a weight that was learned without it.
std::vector<HipPaths> NestedForecasts(const std::vector<ForecastTrial>& trials, int folds) {
  std::vector<HipPaths> centre(trials.size());
  for (int f = 0; f < std::max(1, folds); ++f) {
    const double share = folds > 0 ? LearnInputShare(trials, f) : ForecastRule().input_share;
    for (size_t i = 0; i < trials.size(); ++i) {
      if (trials[i].fold == f) centre[i] = BlendedBy(share, trials[i]);
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

double LearnInputShare(const std::vector<ForecastTrial>& trials, int left_out) {
  double best = kInputShares[0], least = HUGE_VAL;
  for (double share : kInputShares) {
    double sum = 0.0;
    for (const ForecastTrial& trial : trials) {
      if (trial.fold == left_out) continue;
      sum += MeanDistance(trial, BlendedBy(share, trial)).value_or(0.0);
    }
    if (sum < least) least = sum, best = share;
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
  // Who forecasts what: folds, or the model itself.
  std::vector<FoldModel> forecasters = folds;
  if (folds.empty()) {
    forecasters.push_back({model, std::vector<int>(recordings.size())});
    std::iota(forecasters[0].held_out.begin(), forecasters[0].held_out.end(), 0);
  }
  const int count = static_cast<int>(forecasters.size());
  // The filter's numbers: of each fold by what the others say, and last by all.
  std::vector<ForecastRule> inputs(count + 1);
  if (!folds.empty()) inputs = ChooseInputs(recordings, folds, num_threads);
  std::vector<ForecastTrial> trials;
  for (int f = 0; f < count; ++f) {
    const FoldModel& fold = forecasters[f];
    std::vector<std::vector<ForecastTrial>> made(fold.held_out.size());
    ParallelFor(static_cast<int>(made.size()), num_threads, [&](int i) {
      made[i] = TrialsOf(fold.model, inputs[f], recordings[fold.held_out[i]]);
      for (ForecastTrial& trial : made[i]) trial.fold = f, trial.recording = fold.held_out[i];
    });
    for (auto& of_recording : made) {
      std::move(of_recording.begin(), of_recording.end(), std::back_inserter(trials));
    }
  }
  if (trials.empty()) return std::nullopt;
  ForecastRule rule = inputs[count];
  std::set<int> forecast;
  for (const ForecastTrial& trial : trials) forecast.insert(trial.recording);
  rule.folds = static_cast<int>(folds.size());
  rule.recordings = static_cast<int>(forecast.size());
  const std::vector<HipPaths> centre = NestedForecasts(trials, rule.folds);
  if (!folds.empty()) rule.input_share = LearnInputShare(trials);
  rule.errors = LearnErrorScales(trials, centre);
  return rule;
}

}  // namespace pushid
