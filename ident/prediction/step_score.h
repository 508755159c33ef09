// ident: how well it is predicted who steps.
//
//   Brier score  mean of (p - stepped)^2
//   AUC          probability that somebody who steps has a higher p than somebody who does not
//   fifths       tracks by p, five groups of one size: mean p beside the share that stepped
// Standard errors by leaving out one person after the other (jackknife): one body and one habit
// make all of a person's tracks.
#pragma once

#include <string>
#include <vector>

namespace pushid {

// One person in one recording.
struct StepPrediction {
  double margin = 0.0;       // m (results/step_probability.h)
  double probability = 0.0;  // of a step
  bool stepped = false;
  std::string person = {};  // PersonKey
};

struct StepFifth {
  int tracks = 0;
  double predicted = 0.0, observed = 0.0;
};

struct StepScore {
  int tracks = 0, stepped = 0, people = 0;
  double brier = 0.0, brier_error = 0.0;
  double auc = 0.0, auc_error = 0.0;  // 0.5 where nobody stepped, or everybody
  std::vector<StepFifth> fifths;      // fewer where there are fewer than ten tracks

  bool known() const { return tracks > 0; }
  // The largest |predicted - observed| of the fifths.
  double WorstCalibration() const;
};

StepScore ScoreSteps(const std::vector<StepPrediction>& predictions);

}  // namespace pushid
