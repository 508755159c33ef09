// ident: from starts to an optimum: equation error, horizon curriculum, multi-start.
#pragma once

#include <ceres/solver.h>

#include <functional>
#include <string>
#include <vector>

#include "ident/fit_problem.h"

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
  std::vector<TracePoint> trace;
};

// One start of a multi-start.
struct SolveStart {
  std::string kind;  // nominal, equation_error or random
  bool usable = false;
  bool converged = false;
  double cost = 0.0;
  int iterations = 0;
  FitPoint from, to;
  std::vector<SolveStage> stages;
  std::vector<FailedRollout> failed;  // recordings that could not be rolled out to their end
  std::vector<std::string> notes;     // parameters whose start was moved off a bound
  std::string message;
};

struct Solution {
  std::vector<SolveStart> starts;  // in order of trial
  int best = -1;                   // index into starts; -1: no start was usable
  double seconds = 0.0;

  const SolveStart& Best() const { return starts[best]; }
};

// phase: "start 2/8, horizon 32"; called after every accepted iteration.
using SolveProgress = std::function<void(const std::string& phase, int iteration, double cost)>;

// The solver's settings: those of every fit, refit and reference check.
ceres::Solver::Options SolverOptions(const FitOptions& options, const ceres::Problem& problem);

// Solves what was built, from where its point stands.
SolveStage SolveBuilt(FitProblem::Built* built, const ceres::Solver::Options& options, int horizon,
                      std::string* message);

// All frames from a point near the optimum (profiles, bootstrap, leaving recordings out); one
// thread, as refits run in parallel.
SolveStart Refit(const FitProblem& problem, const FitPoint& from);

// Runs one start through the horizons.
SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const std::string& label, const SolveProgress& progress);

// The equation-error optimum, kept within a factor (log scale) or multiple (identity scale) of 5 of
// the nominal values, so that no start sits on a bound.
FitPoint EquationErrorStart(const FitProblem& problem);

// A start on a bound stalls: such values are moved inwards by a tenth of their typical size (on a
// log scale by 10 %). Returns what was moved, in words.
std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point);

// The nominal point with every free gain multiplied by spread^u, u uniform in [-1, 1].
FitPoint RandomStart(const FitProblem& problem, double spread, uint64_t seed);

// All starts; the best usable one by cost, with fewer failed recordings winning first.
Solution Solve(const FitProblem& problem, const SolveProgress& progress = nullptr);

}  // namespace pushid
