// ident: cost functions evaluated ahead over threads, so that Ceres itself runs in one and adds up
// in one order: every number of threads gives the same bits.
//
// Before each evaluation of a problem Ceres calls PrepareForEvaluation; every wrapped cost function
// is evaluated there, each into its own place, and hands out what it holds when Ceres asks.
// Rejected: Ceres' own threads, whose partial sums of cost and gradient depend on their number;
// where a fit ends by a loose tolerance that moved parameters by 2.5 %.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <memory>
#include <vector>

#include "residuals/cost_functions/condensed_rollout.h"

namespace pushid {

class ParallelEvaluation : public ceres::EvaluationCallback {
 public:
  explicit ParallelEvaluation(int num_threads);
  ~ParallelEvaluation() override;

  // To be added to the problem in place of `cost`, which acts on `blocks`.
  std::unique_ptr<ceres::CostFunction> Wrap(std::unique_ptr<ceres::CostFunction> cost,
                                            const std::vector<double*>& blocks);
  // The constant blocks of this problem need no derivatives.
  void set_problem(const ceres::Problem* problem) { problem_ = problem; }
  // The groups of the wrapped rollouts.
  void set_side_by_side(std::shared_ptr<const std::vector<SideBySide>> groups) {
    side_by_side_ = std::move(groups);
  }

  // The rollout in lanes that Wrap was given, and its sums at the last preparation; null for other
  // cost functions. structured_secants.h adds sums up without rows between.
  static const RolloutProblem* ProblemOf(const ceres::CostFunction* cost);
  static const RolloutSums* SumsOf(const ceres::CostFunction* cost);

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  class Prepared;
  // One cost function, or rollouts side by side (lanes; else null).
  struct Task {
    std::vector<Prepared*> members;
    const LaneGroup* lanes;
  };
  void SetTasks();

  int num_threads_;
  const ceres::Problem* problem_ = nullptr;
  std::shared_ptr<const std::vector<SideBySide>> side_by_side_;
  std::vector<Prepared*> prepared_;  // owned by the problem
  std::vector<Task> tasks_;          // of all of them; from the first evaluation on
};

}  // namespace pushid
