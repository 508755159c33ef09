// residuals: the rows of a rollout.
#include "residuals/cost_functions/rollout_problem.h"

namespace pushid {

Derivatives WantedDerivatives(const RolloutProblem& problem, double** jacobians) {
  if (jacobians == nullptr) return Derivatives::kNone;
  const bool weights = jacobians[problem.layout.num_blocks() - 1] != nullptr;
  return problem.map.num_weights == 0 || weights ? Derivatives::kAll : Derivatives::kHeldWeights;
}

RolloutStatus RollOut(const RolloutProblem& p, double const* const* blocks,
                      RolloutPath<double>* path) {
  const Scene& scene = p.recording->scene;
  const SensitivityInputs inputs = RolloutInputs(scene, p.map, p.layout, blocks);
  return Rollout<double>(scene, p.options, inputs.parameters, inputs.initial_velocity, p.horizon,
                         path, nullptr, inputs.network_weights);
}

RolloutStatus VisitFrames(const RolloutProblem& p, double const* const* blocks,
                          Derivatives derivatives, const FrameVisitor& visit,
                          const PlateVisitor& plates) {
  SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  if (derivatives == Derivatives::kHeldWeights) inputs.HoldWeights();
  if (derivatives == Derivatives::kNone) inputs.num_columns = 0;
  // A thread's own, used again: asking the system for them each time costs a tenth of a rollout.
  thread_local std::vector<double> residuals;
  thread_local RowMajorMatrix rows;
  const RolloutStatus status = RowsByJets(p, inputs, &residuals, &rows);
  if (!status.ok) return status;
  int row = 0;
  FrameRows of_frame(kFrameResiduals, inputs.num_columns);
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < p.recording->num_people(); ++n, row += kFrameResiduals) {
      of_frame = rows.middleRows<kFrameResiduals>(row);
      visit(t, n, Eigen::Map<const FrameVector<double>>(residuals.data() + row), &of_frame);
    }
  }
  if (!plates) return status;
  const std::vector<int> people = p.PeopleOnPlates();
  PlateRows of_plate(kPlateResiduals, inputs.num_columns);
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (int n : people) {
      of_plate = rows.middleRows<kPlateResiduals>(row);
      plates(t, n, Eigen::Map<const PlateVector<double>>(residuals.data() + row), &of_plate);
      row += kPlateResiduals;
    }
  }
  return status;
}

bool RolloutResiduals(const RolloutProblem& p, double const* const* blocks, double* residuals) {
  return RolloutResidual::At<double>(p, blocks, residuals).ok;
}

}  // namespace pushid
