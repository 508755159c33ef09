// ident: how well it is predicted who steps.
//
//   Brier score  mean of (p - stepped)^2
//   AUC          probability that somebody who steps has a higher p than somebody who does not
//   fifths       tracks by p, five groups of one size: mean p beside the share that stepped
//   lift-off     predicted minus recorded time of the first, of those who step in both
// Standard errors by leaving out one person after the other (jackknife): one body and one habit
// make all of a person's tracks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace pushid {

// When somebody steps, and how far, s from frame 0: the first phase that a model with step states
// predicts (predicted_steps.h), and the first lift-off that was recorded.
struct StepTiming {
  std::optional<double> lift_off, landing;           // no landing: still stepping in the last frame
  Eigen::Vector2d travel = Eigen::Vector2d::Zero();  // of the cart, m
  std::optional<double> recorded_lift_off;
};

// One person in one recording.
struct StepPrediction {
  double margin = 0.0;       // m (results/step_probability.h)
  double probability = 0.0;  // of a step
  bool stepped = false;
  std::string person = {};  // PersonKey
  // Where the model has step states. In a cross-validation: of the first fold that held it out.
  std::optional<StepTiming> timing = {};
};

struct StepFifth {
  int tracks = 0;
  double predicted = 0.0, observed = 0.0;
};

struct LiftOffError {
  int people = 0;                            // who step in both
  double median = 0.0, mean_absolute = 0.0;  // s; positive: predicted too late
};

struct StepScore {
  int tracks = 0, stepped = 0, people = 0;
  double brier = 0.0, brier_error = 0.0;
  double auc = 0.0, auc_error = 0.0;  // 0.5 where nobody stepped, or everybody
  std::vector<StepFifth> fifths;      // fewer where there are fewer than ten tracks
  LiftOffError lift_off;

  bool known() const { return tracks > 0; }
  // The largest |predicted - observed| of the fifths.
  double WorstCalibration() const;
};

StepScore ScoreSteps(const std::vector<StepPrediction>& predictions);

}  // namespace pushid
