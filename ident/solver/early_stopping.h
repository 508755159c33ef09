// ident: stopping the training of a network before it overfits its recordings.
//
// A share of the recordings, stratified like a fold of the cross-validation, is held out of the
// solve; after each iteration their cost is looked at, and the best point of all is kept.
#pragma once

#include <ceres/iteration_callback.h>

#include "ident/problem/fit_problem.h"

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

}  // namespace pushid
