// ident: what forecasts are put together by, learned from forecasts of recordings that the
// forecasting model was not fitted to.
//
// A model flatters itself on the recordings it was fitted to, the more so the later, and weights
// learned there are wrong ones. So models fitted without a fold of the recordings forecast it, some
// twelve times. From these forecasts come
//   - the numbers of the filter that forecasts: of a few values those of the least mean distance;
//   - the logits of the weights: least mean distance of the hip, with a prior at DefaultLogits;
//   - the scales and quantiles of errors, and the scores: of every fold with numbers and weights
//     learned on the others.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ident/observed/forecast_stack.h"

namespace pushid {

// Fitted to all recordings but those held out (indices).
struct FoldModel {
  IdentifiedModel model;  // with its recording_effect
  std::vector<int> held_out;
};

// model: with its recording_effect. folds: none where there is no model but that one. Numbers and
// weights are then the prior's: on its own recordings it would flatter itself. Error scales and
// scores are still computed. Nothing where no forecast can be made.
std::optional<ForecastStack> LearnForecasts(const IdentifiedModel& model,
                                            const std::vector<PendulumRecording>& recordings,
                                            const std::vector<FoldModel>& folds, int num_threads);

// Of a few values those that make single steps of the recordings most likely, whatever is forecast.
InputNoise LikeliestInput(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings);

// One recording after its first frames, by [person][frame after them].
struct ForecastTrial {
  int fold = 0, recording = 0;
  int moment = 0;  // which of the times after frame 0
  double seconds = 0.0, dt = 0.0;
  Eigen::Matrix3d axes;
  ForecastsOfAll forecasts;
  HipPaths measured;
  std::vector<std::vector<bool>> seen;
  std::vector<Vector3<double>> from;  // hips where they were seen last
};

// Mean distance over people and frames that were seen; none where there are none.
std::optional<double> MeanDistance(const ForecastTrial& trial, const HipPaths& hips);

// Weights of the least mean distance over trials of every fold but one (-1: of all).
std::array<Eigen::Vector3d, kNumForecasters> LearnLogits(const std::vector<ForecastTrial>& trials,
                                                         int left_out = -1);
// centre: of each trial.
std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre);

// The numbers of the filter of unknown forces that forecast best: of each fold by how the other
// folds are forecast, each by the model fitted without it; last, by all of them.
std::vector<ForecastStack> ChooseInputs(const std::vector<PendulumRecording>& recordings,
                                        const std::vector<FoldModel>& folds, int num_threads);

}  // namespace pushid
