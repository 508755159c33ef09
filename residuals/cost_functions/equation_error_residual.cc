// residuals: net force against inverse dynamics at the measured states.
#include "residuals/cost_functions/equation_error_residual.h"

#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {

EquationErrorResidual::EquationErrorResidual(const PendulumRecording& recording,
                                             const ModelOptions& options, const ParameterMap& map,
                                             int window)
    : recording_(recording),
      options_(options),
      map_(map),
      layout_(map, PoolingUnits(recording, map.pool_by),
              recording.initial_velocity == InitialVelocity::kFree) {
  for (int size : layout_.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(4 * recording.num_frames() * recording.num_people());
  for (const auto& states : recording.states) {
    std::vector<Eigen::Vector4d> q;
    for (const PendulumState<double>& state : states) q.push_back(state.q);
    smoothed_.push_back(SavitzkyGolay(q, window, recording.scene.dt));
  }
}

bool EquationErrorResidual::Evaluate(double const* const* blocks, double* residuals,
                                     double** jacobians) const {
  const Scene& scene = recording_.scene;
  const SensitivityInputs inputs = RolloutInputs(scene, map_, layout_, blocks);
  const std::vector<SelfForce> self = SelfForces(scene, options_);
  const ActingColumns columns(layout_);
  RowMajorMatrix by_column(4, inputs.num_columns);
  SelfForce::Jacobian jacobian;
  int row = 0;
  // Equation error serves the start of a fit: contact is left at its nominal values there.
  for (int t = 0; t < recording_.num_frames(); ++t) {
    for (int n = 0; n < scene.num_people(); ++n, row += 4) {
      const Body& body = scene.people[n].body;
      const PosedPendulum<double> state({smoothed_[n][t].value, smoothed_[n][t].rate});
      const Vector4<double>& before = smoothed_[n][t > 0 ? t - 1 : 0].rate;
      const double cart = 1.0 / body.mass;
      const double angle = 1.0 / (body.point_mass() * body.rod_length);
      const Vector4<double> scale(cart, cart, angle, angle);
      Eigen::Map<Vector4<double>> r(residuals + row);
      const NetForce<double> force =
          NetForceAt(scene, options_, self[n], inputs.parameters[n], n, t, state, before);
      r = scale.cwiseProduct(force.Total() -
                             InverseDynamics(body, state, smoothed_[n][t].acceleration));
      if (jacobians == nullptr) continue;
      NetForceJacobian(scene, options_, self[n], inputs.parameters[n], n, t, state, before,
                       &jacobian);
      by_column.setZero();
      for (const ColumnEntry& entry : inputs.entries[n]) {
        by_column.col(entry.column) +=
            entry.derivative * scale.cwiseProduct(jacobian.by_parameter.col(entry.parameter));
      }
      columns.Scatter(by_column, row, num_residuals(), jacobians);
    }
  }
  return true;
}

}  // namespace pushid
