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

ContactJacobian ComputeContactJacobian(const ContactPair& pair, const ParameterSet<double>& p,
                                       const PendulumState<double>& n,
                                       const PendulumState<double>& j) {
  constexpr int kParameters = 5;
  using Jet = ceres::Jet<double, 16 + kParameters>;
  PendulumState<Jet> a, b;
  for (int i = 0; i < 4; ++i) {
    a.q[i] = Jet(n.q[i], i);
    a.qd[i] = Jet(n.qd[i], 4 + i);
    b.q[i] = Jet(j.q[i], 8 + i);
    b.qd[i] = Jet(j.qd[i], 12 + i);
  }
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = Jet(p[i]);
  for (int i = 0; i < kParameters; ++i) {
    parameters[kContactStiffness + i] = Jet(p[kContactStiffness + i], 16 + i);
  }
  const ContactForce<Jet> force = ContactBetween(pair, parameters, a, b);
  ContactJacobian jacobian;
  jacobian.loaded = force.loaded;
  for (int row = 0; row < 4; ++row) {
    jacobian.by_states.row(row) = force.on_n[row].v.head<16>().transpose();
    jacobian.by_states.row(4 + row) = force.on_j[row].v.head<16>().transpose();
    jacobian.by_parameter.row(row) = force.on_n[row].v.tail<kParameters>().transpose();
    jacobian.by_parameter.row(4 + row) = force.on_j[row].v.tail<kParameters>().transpose();
  }
  return jacobian;
}

namespace {

// Adds what the contacts of one frame pass from person to person.
void AddContactSensitivities(const Scene& scene, const ModelOptions& options,
                             const SensitivityInputs& inputs, const RolloutPath<double>& path,
                             const RolloutSensitivities& sensitivities, int frame,
                             std::vector<Eigen::Matrix<double, 4, Eigen::Dynamic>>* by_column) {
  if (options.interaction == Interaction::kNone) return;
  for (int n = 0; n < scene.num_people(); ++n) {
    for (int j = n + 1; j < scene.num_people(); ++j) {
      const ContactPair pair = PairOf(scene, n, j);
      const ParameterSet<double>& p = inputs.parameters[n];
      const PendulumState<double>&a = path.At(frame, n), &b = path.At(frame, j);
      if (!MayTouch(pair, p, a, b) || !ContactBetween(pair, p, a, b).loaded) continue;
      const ContactJacobian jacobian = ComputeContactJacobian(pair, p, a, b);
      for (int side = 0; side < 2; ++side) {
        const int person = side == 0 ? n : j;
        if (ForcesAt(scene, options.push, person, frame) != ActiveForces::kAll) continue;
        auto& target = (*by_column)[person];
        target += jacobian.by_states.block<4, 8>(4 * side, 0) * sensitivities.At(frame, n);
        target += jacobian.by_states.block<4, 8>(4 * side, 8) * sensitivities.At(frame, j);
        for (const ColumnEntry& entry : inputs.entries[n]) {
          if (entry.parameter < kContactStiffness || entry.parameter > kContactHeight) continue;
          target.col(entry.column) +=
              entry.derivative *
              jacobian.by_parameter.block<4, 1>(4 * side, entry.parameter - kContactStiffness);
        }
      }
    }
  }
}

}  // namespace

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

  std::vector<Eigen::Matrix<double, 4, Eigen::Dynamic>> by_column(
      people, Eigen::Matrix<double, 4, Eigen::Dynamic>(4, inputs.num_columns));
  SelfForce::Jacobian jacobian;
  for (int t = 0; t + 1 < num_frames; ++t) {
    const int before = t > 0 ? t - 1 : 0;
    const std::vector<Vector4<double>> interaction =
        InteractionForces(scene, options, inputs.parameters, *path, t);
    for (int n = 0; n < people; ++n) {
      const Body& body = scene.people[n].body;
      const ParameterSet<double>& p = inputs.parameters[n];
      const PendulumState<double>& state = path->At(t, n);
      const Vector4<double>& previous = path->At(before, n).qd;
      const NetForce<double> force =
          NetForceAt(scene, options, self[n], p, n, t, state, previous, interaction[n]);
      const Vector4<double> a = Acceleration(body, state, force.Total());
      path->At(t + 1, n) = Step(state, a, scene.dt);
      const std::string_view outside = OutsideDomain(path->At(t + 1, n));
      if (!outside.empty()) return {false, t + 1, n, outside};

      NetForceJacobian(scene, options, self[n], p, n, t, state, previous, &jacobian);
      const Matrix4<double> rigid = InverseDynamicsJacobian(body, state, a);
      jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
      jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
      by_column[n].noalias() = jacobian.by_state * sensitivities->At(t, n);
      if (self[n].cart_derivative) {
        by_column[n].topRows<2>() +=
            jacobian.by_previous.asDiagonal() * sensitivities->At(before, n).middleRows<2>(4);
      }
      for (const ColumnEntry& entry : inputs.entries[n]) {
        by_column[n].col(entry.column) +=
            entry.derivative * jacobian.by_parameter.col(entry.parameter);
      }
    }
    AddContactSensitivities(scene, options, inputs, *path, *sensitivities, t, &by_column);
    for (int n = 0; n < people; ++n) {
      const auto now = sensitivities->At(t, n);
      const Matrix4<double> inverse_mass =
          InverseMassMatrix(scene.people[n].body, path->At(t, n).q);
      auto next = sensitivities->At(t + 1, n);
      next.bottomRows<4>().noalias() =
          now.bottomRows<4>() + scene.dt * (inverse_mass * by_column[n]);
      next.topRows<4>() = now.topRows<4>() + scene.dt * next.bottomRows<4>();
    }
  }
  return {};
}

}  // namespace pushid
