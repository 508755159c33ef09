// ident: how networks are trained: early stopping, and networks too large for Gauss-Newton.
//
// Early stopping: a share of the recordings, stratified like a fold of the cross-validation, is
// held out of the solve; after each iteration their cost is looked at, and the best point of all is
// kept.
#pragma once

#include <ceres/iteration_callback.h>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

namespace pushid {

// How often each recording counts in the training and, the others, in the judging.
struct EarlyStoppingSplit {
  std::vector<int> training, held_out;
};
// Errors: a share that holds out none or all of the recordings.
Result<EarlyStoppingSplit> SplitForEarlyStopping(const FitProblem& problem, double share,
                                                 uint64_t seed);

class EarlyStopping : public ceres::IterationCallback {
 public:
  // point: the one that is being solved (with Solver::Options::update_state_every_iteration).
  EarlyStopping(const FitProblem& held_out, const FitPoint* point);
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override;

  const FitPoint& best() const { return best_; }
  bool stopped() const { return stopped_; }

 private:
  const FitProblem& held_out_;
  const FitPoint* point_;
  FitPoint best_;
  double best_cost_;
  int since_best_ = 0;
  bool stopped_ = false;
};

// Large networks inside an ordinary fit: first the physical model without them, then their weights
// by the adjoint gradient and L-BFGS (large_networks/large_network_fit.h), and then the physical
// parameters again, with the network held as it is.
//
// The weights learn beside the first step's parameters, those of each setting or person where they
// differ, and count the data as that step does: its sigmas and its weight of the recordings.

// The fit without its network: the first of the steps.
FitOptions PhysicsAlone(FitOptions options);

// What the first step found.
struct FittedPhysics {
  FitOptions options;  // PhysicsAlone's, with what was estimated
  FitPoint point;
};

// The second step: the options of the last one, with the trained network, held, and the physical
// parameters' values to start from. Errors: what the adjoint gradient refuses (free initial
// velocities).
using LargeNetworkTrainer = Result<FitOptions> (*)(const std::vector<PendulumRecording>& recordings,
                                                   const FitOptions& options,
                                                   const FittedPhysics& physics,
                                                   const SolveProgress& progress);
// Set by the library pushid_large_networks in programs that link it, elsewhere null.
LargeNetworkTrainer& LargeNetworkTraining();
// Errors: this program does not link it.
Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const FittedPhysics& physics,
                                     const SolveProgress& progress);

}  // namespace pushid
