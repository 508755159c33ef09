// ident: what a solve went through, where it ended, and how well a likelihood
// explains the recordings there.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ident/problem/fit_point.h"

namespace pushid {

// One iteration of the solver.
struct TracePoint {
  int horizon = 0;  // frames; 0: all
  int iteration = 0;
  double cost = 0.0;
  double gradient = 0.0;  // largest component
};

struct SolveStage {
  int horizon = 0;  // frames; 0: all
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;
  bool converged = false;
  bool cramped = false;  // in a trust region smaller than the first: steps were refused
  std::vector<TracePoint> trace;
};

struct SolveStart {
  std::string kind;  // nominal, rollouts, or warm: from another optimum
  bool usable = false;
  bool converged = false;
  double cost = 0.0;
  int iterations = 0;
  FitPoint from, to;
  RecordingSums recordings;  // at `to`, by the weights of the last solve; while one follows another
  std::vector<SolveStage> stages;
  std::vector<FailedRollout> failed;  // recordings that could not be rolled out to their end
  std::vector<std::string> notes;     // parameters whose start was moved off a bound
  std::string message;

  // A solve on from here.
  void Add(const SolveStage& stage) {
    stages.push_back(stage);
    iterations += stage.iterations;
    cost = stage.final_cost;
    converged = stage.converged;
  }
};

struct Solution {
  SolveStart start;
  double seconds = 0.0;
  bool settled = false;  // the data's weights within 1 %, or the likelihood, from round to round

  bool ok() const { return start.usable; }
};

// phase: "32 frames"; called after every accepted iteration.
using SolveProgress = std::function<void(const std::string& phase, int iteration, double cost)>;

// How well a fit by a likelihood explains the recordings, to compare with other models by the same
// likelihood of the same recordings.
struct LikelihoodScore {
  double deviance = 0.0;  // -2 log likelihood
  int measured = 0;       // numbers
  int parameters = 0;     // free ones, units' deviations not counted

  double Aic() const { return deviance + 2.0 * parameters; }
  double Bic() const {
    return deviance + std::log(static_cast<double>(std::max(1, measured))) * parameters;
  }
};

}  // namespace pushid
