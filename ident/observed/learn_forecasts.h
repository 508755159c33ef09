// ident: what forecasts are put together by, learned from forecasts of recordings that the
// forecasting model was not fitted to.
//
// A model flatters itself on the recordings it was fitted to, the more so the later, and what is
// learned there is wrong. So models fitted without a fold of the recordings forecast it, some
// twelve times. From these forecasts come
//   - the tail of the filter and T of the rule: of a few values those of the least mean distance of
//     the hip where both have a word;
//   - the scales and quantiles of errors: of every fold with numbers learned on the others.
#pragma once

#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "ident/observed/first_frames.h"

namespace pushid {

// Fitted to all recordings but those held out (indices).
struct FoldModel {
  IdentifiedModel model;
  std::vector<int> held_out;
};

// folds: none where there is no model but that one, which would flatter itself: only error scales
// are then learned. Nothing where no recording stays in the model's domain.
std::optional<ForecastRule> LearnForecasts(const IdentifiedModel& model,
                                           const std::vector<PendulumRecording>& recordings,
                                           const std::vector<FoldModel>& folds, int num_threads);

// Tails of the filter over the model's that are tried.
inline constexpr double kTails[] = {1.0, 1.5, 2.2};

// One recording after its first frames, by [person][frame after them].
struct ForecastTrial {
  int fold = 0, recording = 0;
  double seconds = 0.0, dt = 0.0;
  Eigen::Matrix3d axes;
  HipPaths physics, measured;
  std::array<HipPaths, std::size(kTails)> input;  // by each tail
  std::vector<std::vector<bool>> seen;
  std::vector<Vector3<double>> from;  // hips where they were seen last
};

// The rule's tail and time of the least mean distance over trials of every fold but one (-1: of
// all).
ForecastRule LearnRule(const std::vector<ForecastTrial>& trials, int left_out = -1);
// centre: of each trial.
std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre);

}  // namespace pushid
