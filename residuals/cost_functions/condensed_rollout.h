// residuals: a whole recording against its rollout, in as few rows as it has columns.
//
//   residuals: F of the normal equations of all rows of RolloutResidual (normal_equations.h), one
//              more than acting columns (parameter_map.h): J'J, J'r and the cost are those of the
//              rows, robust loss and weights included. Without derivatives, [0 ... 0 |r|].
//   blocks:    as RolloutResidual.
// This is what Ceres solves with: a group of five has some 4,000 rows of 36 columns, and 20 rows so
// condensed. Diagnostics ask for the rows of each person, whose errors are clustered.
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "residuals/cost_functions/rollout_residual.h"
#include "residuals/jacobian_method.h"

namespace pushid {

class CondensedRollout : public ceres::CostFunction {
 public:
  CondensedRollout(std::shared_ptr<const RolloutProblem> problem, JacobianMethod method);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  // One person's rows, condensed: as many for each.
  struct PersonRows {
    RowMajorMatrix jacobian;  // by all columns of the blocks, side by side
    Eigen::VectorXd residuals;
    RowMajorMatrix robust_jacobian;  // with the robust loss's own Hessian (frame_residual.h)
  };
  // One for each person; robust: with robust_jacobian, which is empty otherwise. False when the
  // rollout leaves the domain.
  bool EvaluatePeople(double const* const* blocks, bool robust,
                      std::vector<PersonRows>* people) const;
  int num_people() const { return problem_->recording->num_people(); }
  int num_rows() const { return problem_->num_residuals(); }  // before they were condensed
  JacobianMethod method() const { return method_; }

 private:
  RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                      const FrameVisitor& visit) const;

  std::shared_ptr<const RolloutProblem> problem_;
  JacobianMethod method_;
  std::unique_ptr<ceres::CostFunction> oracle_;  // all rows by Jets; null with sensitivities
  ActingColumns columns_;
};

}  // namespace pushid
