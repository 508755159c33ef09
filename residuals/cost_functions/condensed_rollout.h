// residuals: a whole recording against its rollout, condensed: the rows of RolloutResidual.
#pragma once

#include <memory>

#include "residuals/cost_functions/condensed_rows.h"
#include "residuals/jacobian_method.h"

namespace pushid {

class CondensedRollout : public CondensedRows {
 public:
  CondensedRollout(std::shared_ptr<const RolloutProblem> problem, JacobianMethod method);

  int num_rows() const override { return problem().num_residuals(); }
  JacobianMethod method() const { return method_; }

 protected:
  RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                      const RowsVisitor& visit) const override;

 private:
  JacobianMethod method_;
  std::unique_ptr<ceres::CostFunction> oracle_;  // all rows by Jets; null with sensitivities
};

}  // namespace pushid
