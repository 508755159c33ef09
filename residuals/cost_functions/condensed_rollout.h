// residuals: a whole recording against its rollout, condensed: the rows of RolloutResidual. Those
// of people alone are summed up side by side (cost_functions/lane_group.h), in a group of their own
// where Ceres asks for one recording.
#pragma once

#include <memory>

#include "residuals/cost_functions/condensed_rows.h"
#include "residuals/cost_functions/lane_group.h"
#include "residuals/jacobian_method.h"

namespace pushid {

class CondensedRollout : public CondensedRows {
 public:
  CondensedRollout(std::shared_ptr<const RolloutProblem> problem, JacobianMethod method);

  int num_rows() const override { return problem().num_residuals(); }
  JacobianMethod method() const { return method_; }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;
  bool EvaluatePeople(double const* const* blocks, bool robust,
                      std::vector<PersonRows>* people) const override;

  // The problem, where it has lanes and they are to be used; null otherwise.
  const RolloutProblem* in_lanes() const {
    return oracle_ == nullptr && HasLanes(problem()) ? &problem() : nullptr;
  }
  // What Evaluate and EvaluatePeople say, of sums that are there.
  bool Tell(const RolloutSums& sums, double* residuals, double** jacobians) const;
  bool TellPeople(const RolloutSums& sums, bool robust, std::vector<PersonRows>* people) const;

 protected:
  RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                      const RowsVisitor& visit) const override;

 private:
  JacobianMethod method_;
  std::unique_ptr<ceres::CostFunction> oracle_;  // all rows by Jets; null with sensitivities
  // Of a recording that has lanes; laid out where it is first asked for. Ceres evaluates a block
  // from one thread at a time.
  RolloutSums Alone(double const* const* blocks, LaneSums sums) const;
  mutable std::unique_ptr<LaneGroup> alone_;
};

}  // namespace pushid
