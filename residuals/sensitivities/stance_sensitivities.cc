// residuals: the chain rule through feet that stand and step.
#include "residuals/sensitivities/stance_sensitivities.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

using Ids = StanceParameters<double>;

// Inputs of the jets: theta, phi, qd, s, the cart's own forces, then the parameters.
constexpr int kVelocityAt = 2, kStepAt = 6, kCartForceAt = 7, kParametersAt = 9;
constexpr int kInputs = kParametersAt + Ids::kCount;
using StanceJet = ceres::Jet<double, kInputs>;

StanceForces<StanceJet> JetsOfStance(const SelfForce& self, const ParameterSet<double>& p,
                                     const PendulumState<double>& state,
                                     const Eigen::Vector2d& cart_force) {
  PendulumState<StanceJet> jets;
  Eigen::Matrix<StanceJet, 2, 1> force;
  for (int i = 0; i < 2; ++i) {
    jets.q[i] = StanceJet(state.q[i]);
    jets.q[2 + i] = StanceJet(state.q[2 + i], i);
    force[i] = StanceJet(cart_force[i], kCartForceAt + i);
  }
  for (int i = 0; i < 4; ++i) jets.qd[i] = StanceJet(state.qd[i], kVelocityAt + i);
  jets.step = StanceJet(state.step, kStepAt);
  int input = kParametersAt;
  // In the order of kIds, which is that of the members.
  const StanceParameters<StanceJet> parameters(
      [&](Parameter id) { return StanceJet(p[id], input++); });
  return StanceAt(self, parameters, Angles<StanceJet>(jets.q), jets, force);
}

// One output's derivatives by the state, by s and by the parameters. own: of the cart's forces.
struct OutputJacobian {
  Eigen::Matrix<double, 1, 8> by_state = Eigen::Matrix<double, 1, 8>::Zero();
  double by_step = 0.0;
  Eigen::Matrix<double, 1, kNumParameters> by_parameter;

  OutputJacobian(const StanceJet& output, const SelfForce::Jacobian& own) {
    by_state.segment<2>(2) = output.v.head<2>().transpose();
    by_state.tail<4>() = output.v.segment<4>(kVelocityAt).transpose();
    by_step = output.v[kStepAt];
    const Eigen::RowVector2d by_force = output.v.segment<2>(kCartForceAt).transpose();
    by_state += by_force * own.by_state.topRows<2>();
    by_parameter = by_force * own.by_parameter.topRows<2>();
    for (int i = 0; i < Ids::kCount; ++i) by_parameter[Ids::kIds[i]] += output.v[kParametersAt + i];
  }
};

// Inputs of the jets of standing: theta, phi, their rates, then the parameters.
using StandingIds = StandingParameters<double>;
constexpr int kStandingAt = 4;
using StandingJet = ceres::Jet<double, kStandingAt + StandingIds::kCount>;

Eigen::Matrix<StandingJet, 2, 1> JetsOfStanding(const SelfForce& self,
                                                const ParameterSet<double>& p,
                                                const PendulumState<double>& state) {
  Vector4<StandingJet> q, qd;
  for (int i = 0; i < 2; ++i) {
    q[i] = StandingJet(state.q[i]);
    qd[i] = StandingJet(state.qd[i]);
    q[2 + i] = StandingJet(state.q[2 + i], i);
    qd[2 + i] = StandingJet(state.qd[2 + i], 2 + i);
  }
  int input = kStandingAt;
  // In the order of kIds, which is that of the members.
  const StandingParameters<StandingJet> parameters(
      [&](Parameter id) { return StandingJet(p[id], input++); });
  return StandingTorque(self, parameters, Angles<StandingJet>(q), qd);
}

// Of M a + C + G of the body that stands, by the height of its centre of mass.
Vector4<double> InverseDynamicsByComHeight(const Body& body, double com_height,
                                           const PendulumState<double>& state,
                                           const Vector4<double>& a) {
  using Jet = ceres::Jet<double, 1>;
  const PendulumState<Jet> still{state.q.cast<Jet>(), state.qd.cast<Jet>()};
  const Vector4<Jet> value =
      InverseDynamics<Jet>(StandingBody(body, Jet(com_height, 0)), still, a.cast<Jet>());
  return {value[0].v[0], value[1].v[0], value[2].v[0], value[3].v[0]};
}

// By q and by the parameters of the tail.
void AddTailJacobianAtHip(const ScenePush& push, const SelfForce& self,
                          const ParameterSet<double>& p, int frame, double dt,
                          const Vector4<double>& q, SelfForce::Jacobian* jacobian) {
  if (!TailActs(push, frame)) return;
  constexpr Parameter kTail[] = {kTailGain, kTailTime, kTailExponent};
  using TailJet = ceres::Jet<double, 5>;
  ParameterSet<TailJet> parameters;
  for (int i = 0; i < 3; ++i) parameters[kTail[i]] = TailJet(p[kTail[i]], 2 + i);
  const Vector4<TailJet> angles{TailJet(q[0]), TailJet(q[1]), TailJet(q[2], 0), TailJet(q[3], 1)};
  const Vector4<TailJet> force =
      TailForceAtHip(push, parameters, self.body, Angles<TailJet>(angles), frame, dt);
  for (int row = 0; row < 4; ++row) {
    jacobian->by_state.row(row).segment<2>(2) += force[row].v.head<2>().transpose();
    for (int i = 0; i < 3; ++i) jacobian->by_parameter(row, kTail[i]) += force[row].v[2 + i];
  }
}

void AddPublishedFriction(SelfForce::Jacobian* jacobian) {
  for (int i = 0; i < 2; ++i) jacobian->by_state(i, 4 + i) = -kPublishedFriction;
}

}  // namespace

void NetForceJacobianOfStanding(const Scene& scene, const ModelOptions& options,
                                const SelfForce& self, const ParameterSet<double>& p, int person,
                                int frame, const PendulumState<double>& state,
                                const Vector4<double>& a, SelfForce::Jacobian* jacobian) {
  jacobian->by_state.setZero();
  jacobian->by_previous.setZero();
  jacobian->by_parameter.setZero();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(jacobian);
  if (active != ActiveForces::kAll) return;
  const Eigen::Matrix<StandingJet, 2, 1> torque = JetsOfStanding(self, p, state);
  for (int i = 0; i < 2; ++i) {
    jacobian->by_state(i, 4 + i) = -kHeldFast * self.body.mass;
    jacobian->by_state.row(2 + i).segment<2>(2) = torque[i].v.head<2>().transpose();
    jacobian->by_state.row(2 + i).tail<2>() = torque[i].v.segment<2>(2).transpose();
    for (int k = 0; k < StandingIds::kCount; ++k) {
      jacobian->by_parameter(2 + i, StandingIds::kIds[k]) = torque[i].v[kStandingAt + k];
    }
  }
  jacobian->by_parameter.col(kComHeight) -=
      InverseDynamicsByComHeight(self.body, p[kComHeight], state, a);
  self.AddOwnJacobian(p, state, jacobian);
}

void NetForceJacobianOfStance(const Scene& scene, const ModelOptions& options,
                              const SelfForce& self, const ParameterSet<double>& p, int person,
                              int frame, const PendulumState<double>& state,
                              const Vector4<double>& a, SelfForce::Jacobian* jacobian,
                              StanceJacobian* stance) {
  const Vector4<double> own =
      self.Friction(p, state.qd) + self.Balance(p, state, state.qd) + self.Linear(p, state);
  SelfForce::Jacobian of_own;
  self.MotionJacobian(p, state, state.qd, &of_own);
  const StanceForces<StanceJet> jets = JetsOfStance(self, p, state, own.head<2>());
  const OutputJacobian next(jets.next_step, of_own);
  stance->next_by_state = next.by_state;
  stance->next_by_step = next.by_step;
  stance->next_by_parameter = next.by_parameter;
  stance->by_step.setZero();
  jacobian->by_state.setZero();
  jacobian->by_previous.setZero();
  jacobian->by_parameter.setZero();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (active == ActiveForces::kPushOnly) return;
  if (active == ActiveForces::kPushAndFriction) return AddPublishedFriction(jacobian);
  const OutputJacobian ground(jets.ground, of_own);
  for (int i = 0; i < 2; ++i) {
    const double after = state.qd[i] + scene.dt * a[i];
    jacobian->by_state.row(i) = state.step * of_own.by_state.row(i) - after * ground.by_state;
    jacobian->by_state(i, 4 + i) -= jets.ground.a;
    jacobian->by_parameter.row(i) =
        state.step * of_own.by_parameter.row(i) - after * ground.by_parameter;
    stance->by_step[i] = own[i] - after * ground.by_step;
    const OutputJacobian torque(jets.torque[i], of_own);
    jacobian->by_state.row(2 + i) = torque.by_state;
    jacobian->by_parameter.row(2 + i) = torque.by_parameter;
    stance->by_step[2 + i] = torque.by_step;
  }
  self.AddOwnJacobian(p, state, jacobian);
  if (options.push_tail == PushTail::kNone) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    AddTailJacobianAtHip(push, self, p, frame, scene.dt, state.q, jacobian);
  }
}

}  // namespace pushid
