// residuals: the chained forward sensitivities.
#include "residuals/rollout_sensitivities.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

// d(M a + C + G)/d(theta, phi, thetad, phid) at fixed acceleration a.
Matrix4<double> InverseDynamicsJacobian(const Body& body, const PendulumState<double>& state,
                                        const Vector4<double>& a) {
  using Jet = ceres::Jet<double, 4>;
  PendulumState<Jet> jets;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = i < 2 ? Jet(state.q[i]) : Jet(state.q[i], i - 2);
    jets.qd[i] = i < 2 ? Jet(state.qd[i]) : Jet(state.qd[i], i);
  }
  const Vector4<Jet> value = InverseDynamics<Jet>(body, jets, a.cast<Jet>());
  Matrix4<double> jacobian;
  for (int row = 0; row < 4; ++row) jacobian.row(row) = value[row].v.transpose();
  return jacobian;
}

}  // namespace

void NetForceJacobian(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                      const ParameterSet<double>& p, int person, int frame,
                      const PendulumState<double>& state, const Vector4<double>& previous,
                      SelfForce::Jacobian* jacobian) {
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  switch (active) {
    case ActiveForces::kAll:
      self.TotalJacobian(p, state, previous, jacobian);
      break;
    case ActiveForces::kPushAndFriction:
      self.FrictionJacobian(p, state.qd, jacobian);
      break;
    case ActiveForces::kPushOnly:
      jacobian->by_state.setZero();
      jacobian->by_previous.setZero();
      jacobian->by_parameter.setZero();
      break;
  }
  if (options.push_tail == PushTail::kNone || active != ActiveForces::kAll) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person) {
      AddTailJacobian(push, p, frame, scene.dt, &jacobian->by_parameter);
    }
  }
}

RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path,
                                       RolloutSensitivities* sensitivities) {
  const int people = scene.num_people();
  const std::vector<SelfForce> self = SelfForces(scene, options);
  *path = RolloutPath<double>(num_frames, people);
  sensitivities->Resize(num_frames, people, inputs.num_columns);
  for (int n = 0; n < people; ++n) {
    path->At(0, n) = {scene.people[n].start.q, inputs.initial_velocity[n]};
    auto start = sensitivities->At(0, n);
    start.setZero();
    if (inputs.velocity_column >= 0) {
      start.block<4, 4>(4, inputs.velocity_column + 4 * n).setIdentity();
    }
  }

  Eigen::Matrix<double, 4, Eigen::Dynamic> by_column(4, inputs.num_columns);
  SelfForce::Jacobian jacobian;
  for (int t = 0; t + 1 < num_frames; ++t) {
    for (int n = 0; n < people; ++n) {
      const Body& body = scene.people[n].body;
      const ParameterSet<double>& p = inputs.parameters[n];
      const PendulumState<double>& state = path->At(t, n);
      const int before = t > 0 ? t - 1 : 0;
      const Vector4<double>& previous = path->At(before, n).qd;
      const NetForce<double> force = NetForceAt(scene, options, self[n], p, n, t, state, previous);
      const Vector4<double> a = Acceleration(body, state, force.Total());
      path->At(t + 1, n) = Step(state, a, scene.dt);
      const std::string_view outside = OutsideDomain(path->At(t + 1, n));
      if (!outside.empty()) return {false, t + 1, n, outside};

      NetForceJacobian(scene, options, self[n], p, n, t, state, previous, &jacobian);
      const Matrix4<double> rigid = InverseDynamicsJacobian(body, state, a);
      jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
      jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();

      const auto now = sensitivities->At(t, n);
      by_column.noalias() = jacobian.by_state * now;
      if (self[n].cart_derivative) {
        by_column.topRows<2>() +=
            jacobian.by_previous.asDiagonal() * sensitivities->At(before, n).middleRows<2>(4);
      }
      for (const ColumnEntry& entry : inputs.entries[n]) {
        by_column.col(entry.column) +=
            entry.derivative * jacobian.by_parameter.col(entry.parameter);
      }
      const Matrix4<double> inverse_mass = InverseMassMatrix(body, state.q);
      auto next = sensitivities->At(t + 1, n);
      next.bottomRows<4>().noalias() = now.bottomRows<4>() + scene.dt * (inverse_mass * by_column);
      next.topRows<4>() = now.topRows<4>() + scene.dt * next.bottomRows<4>();
    }
  }
  return {};
}

}  // namespace pushid
