// ident: what forecasts are put together by, learned from forecasts of recordings that the
// forecasting model was not fitted to.
//
// A model flatters itself on the recordings it was fitted to, the more so the later, and what is
// learned there is wrong. So models fitted without a fold of the recordings forecast it, some
// twelve times. From these forecasts come
//   - the numbers of the filter that forecasts and the weight of what it says: of a few values
//     those of the least mean distance of the hip;
//   - the scales and quantiles of errors: of every fold with numbers learned on the others.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ident/observed/first_frames.h"

namespace pushid {

// Fitted to all recordings but those held out (indices).
struct FoldModel {
  IdentifiedModel model;  // with its recording_effect
  std::vector<int> held_out;
};

// model: with its recording_effect. folds: none where there is no model but that one, which would
// flatter itself: only error scales are then learned. Nothing where no forecast can be made.
std::optional<ForecastRule> LearnForecasts(const IdentifiedModel& model,
                                           const std::vector<PendulumRecording>& recordings,
                                           const std::vector<FoldModel>& folds, int num_threads);

// One recording after its first frames, by [person][frame after them].
struct ForecastTrial {
  int fold = 0, recording = 0;
  double seconds = 0.0, dt = 0.0;
  Eigen::Matrix3d axes;
  HipPaths physics, input, measured;
  std::vector<std::vector<bool>> seen;
  std::vector<Vector3<double>> from;  // hips where they were seen last
};

// ForecastRule::input_share of the least mean distance over trials of every fold but one (-1: of
// all).
double LearnInputShare(const std::vector<ForecastTrial>& trials, int left_out = -1);
// centre: of each trial.
std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre);

}  // namespace pushid
