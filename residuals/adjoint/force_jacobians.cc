// residuals: derivatives of forces by jets over their few inputs.
#include "residuals/adjoint/force_jacobians.h"

#include <ceres/jet.h>

namespace pushid {

void NetForceJacobian(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                      const ParameterSet<double>& p, int person, int frame,
                      const PendulumState<double>& state, const Vector4<double>& previous,
                      SelfForce::Jacobian* jacobian) {
  switch (ForcesAt(scene, options.push, person, frame)) {
    case ActiveForces::kAll:
      self.TotalJacobian(p, state, previous, jacobian);
      break;
    case ActiveForces::kPushAndFriction:
      self.FrictionJacobian(p, state.qd, jacobian);
      return;
    case ActiveForces::kPushOnly:
      jacobian->SetZero();
      return;
  }
  if (options.push_tail == PushTail::kNone) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person) {
      AddTailJacobian(push, self.body.mass, p, frame, scene.dt, &jacobian->by_parameter);
    }
  }
}

PairJacobian ComputePairJacobian(const InteractionTerms& terms, const Pair& pair,
                                 const ParameterSet<double>& p, const PendulumState<double>& n,
                                 const PendulumState<double>& j) {
  using Jet = ceres::Jet<double, 16 + kNumPairParameters>;
  PendulumState<Jet> a, b;
  for (int i = 0; i < 4; ++i) {
    a.q[i] = Jet(n.q[i], i);
    a.qd[i] = Jet(n.qd[i], 4 + i);
    b.q[i] = Jet(j.q[i], 8 + i);
    b.qd[i] = Jet(j.qd[i], 12 + i);
  }
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumPairParameters; ++i) {
    parameters[kFirstPairParameter + i] = Jet(p[kFirstPairParameter + i], 16 + i);
  }
  const PairForce<Jet> force = InteractionBetween<Jet>(terms, pair, parameters, a, b);
  PairJacobian jacobian;
  for (int row = 0; row < 4; ++row) {
    jacobian.by_states.row(row) = force.on_n[row].v.head<16>().transpose();
    jacobian.by_states.row(4 + row) = force.on_j[row].v.head<16>().transpose();
    jacobian.by_parameter.row(row) = force.on_n[row].v.tail<kNumPairParameters>().transpose();
    jacobian.by_parameter.row(4 + row) = force.on_j[row].v.tail<kNumPairParameters>().transpose();
  }
  return jacobian;
}

GateJacobian PairGateJacobian(const PairShape& shape, const Pair& pair,
                              const ParameterSet<double>& p, const Vector4<double>& q_n,
                              const Vector4<double>& q_j) {
  using Jet = ceres::Jet<double, 8 + kContactParameters>;
  Vector4<Jet> n, j;
  for (int i = 0; i < 4; ++i) {
    n[i] = Jet(q_n[i], i);
    j[i] = Jet(q_j[i], 4 + i);
  }
  ParameterSet<Jet> parameters;
  parameters[kNeighbourRange] = Jet(p[kNeighbourRange]);
  for (int i = 0; i < kContactParameters; ++i) {
    parameters[kContactStiffness + i] = Jet(p[kContactStiffness + i], 8 + i);
  }
  const Jet gate = PairGate<Jet>(shape, pair, parameters, n, j);
  return {gate.a, gate.v.head<8>().transpose(), gate.v.tail<kContactParameters>().transpose()};
}

Eigen::Matrix<double, 1, 16> PairInputsByStates(
    const Eigen::Matrix<double, 1, PairShape::kInputs>& by_input) {
  Eigen::Matrix<double, 1, 16> by_states;
  for (int i = 0; i < 2; ++i) {
    by_states[i] = by_input[i] / kPairDistance;
    by_states[4 + i] = by_input[2 + i] / kNetworkSpeed;
    by_states[2 + i] = by_input[4 + 2 * i] / kNetworkAngle;
    by_states[10 + i] = by_input[5 + 2 * i] / kNetworkAngle;
    by_states[6 + i] = by_input[8 + i] / kNetworkRate;
    by_states[8 + i] = -by_states[i];
    by_states[12 + i] = -by_states[4 + i];
    by_states[14 + i] = -by_states[6 + i];
  }
  return by_states;
}

FrameVector<double> FrameResidualWithJacobian(const Body& body, double lift,
                                              const PendulumState<double>& state,
                                              const MeasuredFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              FrameJacobian* jacobian) {
  using Jet = ceres::Jet<double, 10>;
  PendulumState<Jet> jets;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = Jet(state.q[i], i);
    jets.qd[i] = Jet(state.qd[i], 4 + i);
  }
  jets.rod = Jet(state.rod, 8);
  const FrameVector<Jet> r =
      FrameResidual(BodyNow<Jet>(body, jets.rod, Jet(lift, 9)), jets, measured, sigmas);
  FrameVector<double> value;
  for (int row = 0; row < kFrameResiduals; ++row) {
    value[row] = r[row].a;
    jacobian->row(row) = r[row].v.transpose();
  }
  return value;
}

}  // namespace pushid
