// residuals: adjoints of a step.
#include "residuals/adjoint/step_adjoint.h"

#include <ceres/jet.h>

#include "residuals/force_jacobians.h"

namespace pushid {
namespace {

template <typename Jet>
Jet Dot(const Vector4<double>& adjoint, const Vector4<Jet>& of) {
  Jet sum = adjoint[0] * of[0];
  for (int i = 1; i < 4; ++i) sum += adjoint[i] * of[i];
  return sum;
}

// [q, qd] as inputs from `first` on.
template <typename Jet>
PosedPendulum<Jet> Inputs(const PendulumState<double>& state, int first) {
  PendulumState<Jet> inputs;
  for (int i = 0; i < 4; ++i) {
    inputs.q[i] = Jet(state.q[i], first + i);
    inputs.qd[i] = Jet(state.qd[i], first + 4 + i);
  }
  return inputs;
}

// Derivatives of SelfForce::Effort.
SelfJacobian<double> EffortJacobian(const PersonStep& s) {
  SelfJacobian<double> jacobian;
  AddControlJacobian(s.self, s.p, s.state, s.before, &jacobian);
  int column = kFirstOwnParameter;
  for (const auto& law : s.self.laws) {
    const int own = static_cast<int>(law->parameters().size());
    ForceLaw::Inputs inputs = ForceLaw::Inputs::Zero();
    inputs.head<8>() << s.state.q, s.state.qd;
    for (int i = 0; i < own; ++i) inputs[8 + i] = s.p[column + i];
    ForceLaw::Jacobian by_input;
    law->Force({s.self.body, s.self.posture}, inputs, &by_input);
    jacobian.by_state += by_input.leftCols<8>();
    jacobian.by_parameter.middleCols(column, own) += by_input.middleCols(8, own);
    column += own;
  }
  return jacobian;
}

// Derivatives of NetForceAt (models/step.h).
SelfJacobian<double> ForceJacobian(const PersonStep& s) {
  SelfJacobian<double> jacobian;
  const ActiveForces active = ForcesAt(s.scene, s.options.push, s.person, s.frame);
  if (active == ActiveForces::kAll) {
    jacobian = EffortJacobian(s);
    for (const ScenePush& push : s.scene.pushes) {
      if (push.person != s.person || !HasTail(s.options) || !TailActs(push, s.frame)) continue;
      const TailOf<double> tail = TailAt(push, s.self.body.mass, s.frame, s.scene.dt);
      const double rate = tail.Rate(s.p);
      AddTailJacobian(tail, s.p, rate, tail.Decay(rate), &jacobian.by_parameter);
    }
  }
  if (active != ActiveForces::kPushOnly) {
    AddFrictionJacobian(s.self, s.p, s.state.qd, &jacobian);
  }
  return jacobian;
}

void AddBack(const SelfJacobian<double>& jacobian, const Vector4<double>& by_force,
             StateAdjoint* adjoint, ParameterSet<double>* by_parameter) {
  adjoint->state += jacobian.by_state.transpose() * by_force;
  adjoint->before += jacobian.by_previous.cwiseProduct(by_force.head<2>());
  Eigen::Map<Eigen::Matrix<double, kNumParameters, 1>>(by_parameter->data()) +=
      jacobian.by_parameter.transpose() * by_force;
}

}  // namespace

void PersonBack(const PersonStep& s, const Vector4<double>& acceleration,
                const Vector4<double>& by_force, const Vector4<double>* by_effort,
                StateAdjoint* adjoint, ParameterSet<double>* by_parameter) {
  SelfJacobian<double> jacobian = ForceJacobian(s);
  const Matrix4<double> rigid = InverseDynamicsJacobian<double>(
      BodyNow(s.self.body, s.state.rod), Angles<double>(s.state.q), s.state.qd, acceleration);
  jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
  jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
  AddBack(jacobian, by_force, adjoint, by_parameter);
  if (by_effort == nullptr) return;  // of a rod that does not move
  AddBack(EffortJacobian(s), *by_effort, adjoint, by_parameter);
  using Jet = ceres::Jet<double, 1>;
  const PendulumState<Jet> state{s.state.q.cast<Jet>(), s.state.qd.cast<Jet>()};
  const BodyOf<Jet> body = BodyNow<Jet>(s.self.body, Jet(s.state.rod, 0));
  const Vector4<Jet> needed = InverseDynamics(body, state, Vector4<Jet>(acceleration.cast<Jet>()));
  adjoint->rod -= Dot<Jet>(by_force, needed).v[0];
}

void PairBack(const ModelOptions& options, const Pair& pair, const ParameterSet<double>& p,
              const PendulumState<double>& n, const PendulumState<double>& j,
              const Vector4<double>& by_n, const Vector4<double>& by_j, const double* by_gate,
              PairAdjoint* by_states, ParameterSet<double>* by_parameter) {
  using Jet = ceres::Jet<double, 16 + kNumPairParameters>;
  const PosedPendulum<Jet> a = Inputs<Jet>(n, 0), b = Inputs<Jet>(j, 8);
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumPairParameters; ++i) {
    const int id = kFirstPairParameter + i;
    parameters[id] = Jet(p[id], 16 + i);
  }
  const PairForce<Jet> force = InteractionBetween<Jet>(options.interaction, pair, parameters, a, b);
  Jet sum = Dot<Jet>(by_n, force.on_n) + Dot<Jet>(by_j, force.on_j);
  if (by_gate != nullptr) {
    sum += *by_gate * PairGate<Jet>(options.learned->pair, pair, parameters, a.q, b.q);
  }
  *by_states += sum.v.head<16>();
  for (int i = 0; i < kNumPairParameters; ++i) {
    (*by_parameter)[kFirstPairParameter + i] += sum.v[16 + i];
  }
}

PairAdjoint PairInputsBack(const VectorX<double>& by_inputs) {
  using Jet = ceres::Jet<double, 16>;
  const PendulumState<double> at;  // any: the inputs are linear
  const VectorX<Jet> inputs = PairInputs<Jet>(Inputs<Jet>(at, 0), Inputs<Jet>(at, 8));
  PairAdjoint by_states = PairAdjoint::Zero();
  for (int i = 0; i < PairShape::kInputs; ++i) by_states += by_inputs[i] * inputs[i].v;
  return by_states;
}

void FrameBack(const Body& body, const PendulumState<double>& state, const MeasuredFrame& measured,
               const ResidualSigmas& sigmas, double weight, StateAdjoint* adjoint) {
  constexpr int kRodAt = 8;
  using Jet = ceres::Jet<double, 9>;
  PendulumState<Jet> jets = Inputs<Jet>(state, 0);
  jets.rod = Jet(state.rod, kRodAt);
  const FrameVector<Jet> r = FrameResidual(BodyNow<Jet>(body, jets.rod), jets, measured, sigmas);
  const Jet cost = (0.5 * weight * weight) * r.squaredNorm();
  adjoint->state += cost.v.head<8>();
  adjoint->rod += cost.v[kRodAt];
}

}  // namespace pushid
