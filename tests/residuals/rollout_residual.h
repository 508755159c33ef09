// All rows of a recording's rollout as a Ceres cost function, which a fit condenses
// (condensed_rollout.h), by sensitivities; their oracle is RolloutByJets.
#pragma once

#include <memory>
#include <utility>

#include "tests/residuals/rollout_by_jets.h"

namespace pushid {

class RolloutResidual : public ceres::CostFunction {
 public:
  explicit RolloutResidual(std::shared_ptr<const RolloutProblem> problem)
      : problem_(std::move(problem)), columns_(problem_->layout) {
    for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
    set_num_residuals(problem_->num_residuals());
  }

  // false when the rollout leaves the model's domain; last_failure then says where.
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    int row = 0;
    last_failure_ = VisitFrames(
        *problem_, blocks, WantedDerivatives(*problem_, jacobians),
        [&](int, int, const FrameVector<double>& r, FrameRows* by_column) {
          Eigen::Map<FrameVector<double>>(residuals + row) = r;
          if (jacobians != nullptr) columns_.Scatter(*by_column, row, num_residuals(), jacobians);
          row += kFrameResiduals;
        },
        [&](int, int, const PlateVector<double>& r, PlateRows* by_column) {
          Eigen::Map<PlateVector<double>>(residuals + row) = r;
          if (jacobians != nullptr) columns_.Scatter(*by_column, row, num_residuals(), jacobians);
          row += kPlateResiduals;
        });
    return last_failure_.ok;
  }

  const RolloutStatus& last_failure() const { return last_failure_; }

 private:
  std::shared_ptr<const RolloutProblem> problem_;
  ActingColumns columns_;
  mutable RolloutStatus last_failure_;
};

}  // namespace pushid
