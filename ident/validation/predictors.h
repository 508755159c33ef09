// ident: the predictors that cross-validation compares: an identified model, and the baselines
// that any model has to beat.
#pragma once

#include "ident/validation/crossvalidation.h"

namespace pushid {

// How first frames are used.
enum class FirstFrames { kForecast, kReanchored };

// Fits the pendulum model to the training recordings, and to them what first frames tell. observed:
// as in ScoreModel.
class ModelPredictor : public Predictor {
 public:
  ModelPredictor(std::string label, FitOptions options, int observed = 0,
                 FirstFrames use = FirstFrames::kForecast);
  FoldPrediction FitAndScore(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train,
                             const std::vector<int>& test) const override;

 private:
  FitOptions options_;
  FirstFrames use_;
};

// StaticBaseline or ConstantVelocityBaseline; nothing is fitted.
class BaselinePredictor : public Predictor {
 public:
  using Baseline = HipPaths (*)(const PendulumRecording&, int observed);
  BaselinePredictor(std::string label, Baseline baseline, int observed = 0);
  FoldPrediction FitAndScore(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train,
                             const std::vector<int>& test) const override;

 private:
  Baseline baseline_;
};

// Ridge regression from the pushed person's mass, rod length, x-impulse over mass and push frames
// to the displacement of the hip at every frame (paths padded with their last value): no mechanics
// at all.
class RidgePredictor : public Predictor {
 public:
  explicit RidgePredictor(std::string label, double strength = 1.0);
  FoldPrediction FitAndScore(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train,
                             const std::vector<int>& test) const override;

 private:
  double strength_;  // on standardized features
};

}  // namespace pushid
