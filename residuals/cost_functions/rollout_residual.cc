// residuals: the rollout residual by forward sensitivities.
#include "residuals/cost_functions/rollout_residual.h"

#include <algorithm>

#include "residuals/kernels/narrow_product.h"

namespace pushid {

std::vector<std::string> PoolingUnits(const PendulumRecording& recording, PoolBy pool_by) {
  if (!HoldsForRecording(pool_by)) return recording.subject_ids;
  const bool by_condition = pool_by == PoolBy::kCondition && !recording.condition.empty();
  const std::string& unit = by_condition ? recording.condition : recording.setting;
  return std::vector<std::string>(recording.scene.people.size(), unit);
}

std::shared_ptr<const RolloutProblem> MakeRolloutProblem(const PendulumRecording& recording,
                                                         const ModelOptions& options,
                                                         const ParameterMap& map,
                                                         const ResidualSigmas& sigmas,
                                                         double weight, int horizon) {
  auto problem = std::make_shared<RolloutProblem>();
  problem->recording = &recording;
  problem->options = options;
  problem->map = map;
  problem->layout = BlockLayout(map, PoolingUnits(recording, map.pool_by),
                                recording.initial_velocity == InitialVelocity::kFree);
  problem->sigmas = sigmas;
  problem->weight = weight;
  const int frames = recording.num_frames();
  problem->horizon = horizon > 0 ? std::min(horizon, frames) : frames;
  return problem;
}

SensitivityInputs RolloutInputs(const Scene& scene, const ParameterMap& map,
                                const BlockLayout& layout, double const* const* blocks) {
  SensitivityInputs inputs;
  inputs.parameters = layout.Parameters<double>(map, blocks);
  inputs.initial_velocity = InitialVelocities(scene);
  if (const double* free = layout.VelocityBlock(blocks)) {
    for (int n = 0; n < scene.num_people(); ++n) {
      inputs.initial_velocity[n] = Eigen::Map<const Vector4<double>>(free + 4 * n);
    }
  }
  for (int n = 0; n < scene.num_people(); ++n) {
    inputs.entries.push_back(map.Entries(inputs.parameters[n], layout.DeviationColumn(n)));
  }
  inputs.num_columns = layout.num_columns();
  inputs.velocity_column = layout.VelocityColumn();
  inputs.network_weights = layout.WeightBlock(blocks);
  inputs.weight_column = layout.WeightColumn();
  return inputs;
}

void ScatterJacobian(const Eigen::Ref<const RowMajorMatrix>& jacobian,
                     const std::vector<int>& block_sizes, int first_row, int total_rows,
                     double** jacobians) {
  int column = 0;
  for (size_t b = 0; b < block_sizes.size(); column += block_sizes[b++]) {
    if (jacobians[b] == nullptr) continue;
    Eigen::Map<RowMajorMatrix> block(jacobians[b], total_rows, block_sizes[b]);
    block.middleRows(first_row, jacobian.rows()) = jacobian.middleCols(column, block_sizes[b]);
  }
}

RolloutResidual::RolloutResidual(std::shared_ptr<const RolloutProblem> problem)
    : problem_(std::move(problem)) {
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->num_residuals());
}

bool RolloutResidual::Evaluate(double const* const* blocks, double* residuals,
                               double** jacobians) const {
  const RolloutProblem& p = *problem_;
  const Scene& scene = p.recording->scene;
  const SensitivityInputs inputs = RolloutInputs(scene, p.map, p.layout, blocks);
  RolloutPath<double> path;
  RolloutSensitivities sensitivities;
  const RolloutStatus status =
      jacobians != nullptr
          ? RolloutWithSensitivities(scene, p.options, inputs, p.horizon, &path, &sensitivities)
          : Rollout<double>(scene, p.options, inputs.parameters, inputs.initial_velocity, p.horizon,
                            &path, nullptr, inputs.network_weights);
  if (!status.ok) {
    last_failure_ = status;
    return false;
  }

  const std::vector<int> sizes = p.layout.BlockSizes();
  const bool rod_moves = RodMoves(p.options);
  Eigen::Matrix<double, kFrameResiduals, 8> by_state;
  Eigen::Matrix<double, kFrameResiduals, 10> by_rod;  // by_state, by the rod, by the cart's lift
  Eigen::Matrix<double, kFrameResiduals, Eigen::Dynamic, Eigen::RowMajor> by_column(
      kFrameResiduals, inputs.num_columns);
  int row = 0;
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < scene.num_people(); ++n, row += kFrameResiduals) {
      Eigen::Map<FrameVector<double>> r(residuals + row);
      const Body& body = scene.people[n].body;
      const PendulumState<double>& state = path.At(t, n);
      const double lift = inputs.parameters[n][kRodLift];
      if (jacobians == nullptr) {
        r = p.weight * FrameResidual<double>(BodyNow(body, state.rod, lift), state,
                                             p.Measured(t, n), p.sigmas);
        continue;
      }
      if (rod_moves) {
        r = p.weight *
            MovingRodResidualWithJacobian(body, lift, state, p.Measured(t, n), p.sigmas, &by_rod);
        by_state = by_rod.leftCols<8>();
      } else {
        r = p.weight *
            FrameResidualWithJacobian(body, state, p.Measured(t, n), p.sigmas, &by_state);
      }
      by_state *= p.weight;
      SetNarrowProduct(by_state, sensitivities.At(t, n), by_column);
      if (rod_moves) {
        by_column.noalias() += (p.weight * by_rod.col(8)) * sensitivities.Rod(t, n);
        for (const ColumnEntry& entry : inputs.entries[n]) {
          if (entry.parameter != kRodLift) continue;
          by_column.col(entry.column) += (p.weight * entry.derivative) * by_rod.col(9);
        }
      }
      ScatterJacobian(by_column, sizes, row, num_residuals(), jacobians);
    }
  }
  return true;
}

}  // namespace pushid
