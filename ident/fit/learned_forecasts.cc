// ident: trials of forecasts, the blend that errs least, bands that hold.
#include "ident/fit/learned_forecasts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/parallel.h"

namespace pushid {
namespace {

constexpr double kTrialSpacing = 0.1, kLastTrial = 0.75;  // s after frame 0
constexpr int kFramesAfter = 5;                           // at least
constexpr double kRateStep = 0.05, kLargestRate = 4.0;    // 1/s
constexpr double kNinety = 1.6448536269514722;  // standard deviations that hold 90 % of a normal

// One recording after its first frames; by [person][frame after them].
struct Trial {
  double seconds = 0.0;
  Eigen::Matrix3d axes;
  Forecast forecast;
  HipPaths measured;
  std::vector<std::vector<bool>> seen;
  HipPaths deviation;  // on the axes
};

struct TrialsOfRecording {
  std::vector<Trial> trials;
  double error = 0.0, error_without = 0.0;  // mean squares over g^2, with and without the effect
};

HipPaths DeviationsOf(const RecordingFilter& filter, const RecordingEffect& effect) {
  std::vector<double> weights;
  HipPaths deviations;
  for (const auto& person : filter.Mixture(effect, &weights)) {
    deviations.emplace_back();
    for (const MixturePoint& point : person) {
      Vector3<double> mean = Vector3<double>::Zero(), square = mean;
      for (size_t j = 0; j < weights.size(); ++j) mean += weights[j] * point.mean[j];
      for (size_t j = 0; j < weights.size(); ++j) {
        square += weights[j] * (point.mean[j] - mean).cwiseAbs2();
      }
      deviations.back().push_back((square + point.deviation.cwiseAbs2()).cwiseSqrt());
    }
  }
  return deviations;
}

double MeanSquare(const PendulumRecording& recording, const HipPaths& hips) {
  double sum = 0.0, frames = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 1; t < hips[n].size(); ++t, ++frames) {
      sum += (recording.hip[n][t] - hips[n][t]).squaredNorm();
    }
  }
  return frames > 0.0 ? sum / frames : 0.0;
}

Trial MakeTrial(const PendulumRecording& recording, const RecordingFilter& filter,
                const RecordingEffect& effect, const HipPaths& hips) {
  Trial trial;
  trial.seconds = filter.seconds();
  trial.axes = filter.Axes();
  trial.forecast = filter.ForecastOf(hips);
  trial.deviation = DeviationsOf(filter, effect);
  for (int n = 0; n < recording.num_people(); ++n) {
    trial.measured.emplace_back(recording.hip[n].begin() + filter.observed(),
                                recording.hip[n].end());
    trial.seen.emplace_back();
    for (int t = filter.observed(); t < filter.frames(); ++t) {
      trial.seen[n].push_back(recording.Weight(n, t) > 0.0);
    }
  }
  return trial;
}

TrialsOfRecording MakeTrials(const IdentifiedModel& model, const RecordingEffect& effect,
                             RecordingToForecast* of) {
  TrialsOfRecording made;
  const PendulumRecording& recording = *of->recording;
  const int frames = recording.num_frames();
  RecordingFilter& filter = of->filter;
  double next = kTrialSpacing;
  for (int t = 1; t < frames; ++t) {
    filter.Observe(HipsAt(recording, t));
    if (filter.seconds() < next - 1e-9 || next > kLastTrial || t + kFramesAfter >= frames) continue;
    next += kTrialSpacing;
    const HipPaths hips = HipsOfRollout(model, recording, filter.Effect(effect).mean, frames);
    if (!hips.empty()) made.trials.push_back(MakeTrial(recording, filter, effect, hips));
  }
  if (!filter.acts()) return made;
  const double unit = filter.error_unit() * filter.error_unit();
  made.error_without = MeanSquare(recording, HipsOfRollout(model, recording, 0.0, frames)) / unit;
  made.error =
      MeanSquare(recording, HipsOfRollout(model, recording, filter.Effect(effect).mean, frames)) /
      unit;
  return made;
}

// Mean distance over people and frames that were seen.
double ErrorOf(const Trial& trial, double l) {
  const HipPaths hips = trial.forecast.Blended(l);
  double sum = 0.0, frames = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 0; t < hips[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      sum += (hips[n][t] - trial.measured[n][t]).norm();
      frames += 1.0;
    }
  }
  return frames > 0.0 ? sum / frames : 0.0;
}

double LearnedRate(const std::vector<TrialsOfRecording>& recordings) {
  RecordingEffect tried;
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (; tried.blend_rate <= kLargestRate; tried.blend_rate += kRateStep) {
    double sum = 0.0;
    for (const TrialsOfRecording& recording : recordings) {
      for (const Trial& trial : recording.trials) {
        sum += ErrorOf(trial, tried.Blend(trial.seconds));
      }
    }
    if (sum < least) least = sum, best = tried.blend_rate;
  }
  return best;
}

// 90 % of all frames need no wider bands than these.
Vector3<double> LearnedWidening(const std::vector<TrialsOfRecording>& recordings,
                                const RecordingEffect& effect) {
  std::vector<double> needed[3];
  for (const TrialsOfRecording& recording : recordings) {
    for (const Trial& trial : recording.trials) {
      const HipPaths hips = trial.forecast.Blended(effect.Blend(trial.seconds));
      for (size_t n = 0; n < hips.size(); ++n) {
        for (size_t t = 0; t < hips[n].size(); ++t) {
          if (!trial.seen[n][t]) continue;
          const Vector3<double> error =
              trial.axes.transpose() * (trial.measured[n][t] - hips[n][t]);
          for (int i = 0; i < 3; ++i) {
            const double deviations = std::abs(error[i]) / trial.deviation[n][t][i];
            needed[i].push_back((deviations / kNinety - 1.0) / (trial.seconds * trial.seconds));
          }
        }
      }
    }
  }
  Vector3<double> widening = Vector3<double>::Zero();
  for (int i = 0; i < 3; ++i) {
    if (needed[i].empty()) continue;
    const auto at = needed[i].begin() + static_cast<std::ptrdiff_t>(0.9 * needed[i].size());
    std::nth_element(needed[i].begin(), at, needed[i].end());
    widening[i] = std::max(0.0, *at);
  }
  return widening;
}

}  // namespace

void LearnForecasts(const IdentifiedModel& model, std::vector<RecordingToForecast> recordings,
                    int num_threads, RecordingEffect* effect) {
  std::vector<TrialsOfRecording> made(recordings.size());
  ParallelFor(static_cast<int>(recordings.size()), num_threads,
              [&](int i) { made[i] = MakeTrials(model, *effect, &recordings[i]); });
  double error = 0.0, without = 0.0;
  for (const TrialsOfRecording& recording : made) {
    error += recording.error;
    without += recording.error_without;
  }
  effect->explained = without > 0.0 ? 1.0 - error / without : 0.0;
  effect->blend_rate = LearnedRate(made);
  effect->widening = LearnedWidening(made, *effect);
}

}  // namespace pushid
