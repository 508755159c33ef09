// residuals: net force against inverse dynamics at the measured states.
#include "residuals/cost_functions/equation_error_residual.h"

#include "residuals/cost_functions/rollout_problem.h"
#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {

EquationErrorResidual::EquationErrorResidual(const PendulumRecording& recording,
                                             const ModelOptions& options, const ParameterMap& map,
                                             int window)
    : recording_(recording),
      options_(options),
      map_(map),
      layout_(LayoutOf(recording, map, recording.initial_velocity == InitialVelocity::kFree)) {
  for (int size : layout_.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(4 * recording.num_frames() * recording.num_people());
  for (const auto& states : recording.states) {
    std::vector<Eigen::Vector4d> q;
    for (const PendulumState<double>& state : states) q.push_back(state.q);
    const Body& body = recording.scene.people[measured_.size()].body;
    std::vector<Measured>& frames = measured_.emplace_back();
    for (const SmoothedSample& smooth : SavitzkyGolay(q, window, recording.scene.dt)) {
      const PendulumState<double> state{smooth.value, smooth.rate};
      frames.push_back({state, InverseDynamics(body, state, smooth.acceleration)});
    }
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
      const PosedPendulum<double>& state = measured_[n][t].state;
      const Vector4<double>& before = measured_[n][t > 0 ? t - 1 : 0].state.qd;
      const double cart = 1.0 / body.mass;
      const double angle = 1.0 / (body.point_mass() * body.rod_length);
      const Vector4<double> scale(cart, cart, angle, angle);
      Eigen::Map<Vector4<double>> r(residuals + row);
      const NetForce<double> force =
          NetForceAt(scene, options_, self[n], inputs.parameters[n], n, t, state, before);
      r = scale.cwiseProduct(force.Total() - measured_[n][t].force);
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
