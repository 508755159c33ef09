// residuals: the chain rule through feet that stand and step.
#include "residuals/sensitivities/stance_sensitivities.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

using Ids = StanceParameters<double>;

// Inputs of the jets: theta, phi, qd, s, the cart's own forces, what ankles perceive (two angles
// and their rates), what steps perceive (two angles, qd), then the parameters.
constexpr int kVelocityAt = 2, kStepAt = 6, kCartForceAt = 7, kAnkleAt = 9, kFootAt = 13;
constexpr int kParametersAt = 19;
constexpr int kInputs = kParametersAt + Ids::kCount;
using StanceJet = ceres::Jet<double, kInputs>;

StanceForces<StanceJet> JetsOfStance(const SelfForce& self, const ParameterSet<double>& p,
                                     const PendulumState<double>& state,
                                     const Perceived<double>& perceived,
                                     const Eigen::Vector2d& cart_force) {
  PendulumState<StanceJet> jets;
  Perceived<StanceJet> felt;
  for (int i = 0; i < 2; ++i) {
    felt.ankle.q[2 + i] = StanceJet(perceived.ankle.q[2 + i], kAnkleAt + i);
    felt.ankle.qd[2 + i] = StanceJet(perceived.ankle.qd[2 + i], kAnkleAt + 2 + i);
    felt.step.q[2 + i] = StanceJet(perceived.step.q[2 + i], kFootAt + i);
  }
  for (int i = 0; i < 4; ++i) {
    felt.step.qd[i] = StanceJet(perceived.step.qd[i], kFootAt + 2 + i);
  }
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
  return StanceAt(self, parameters, Angles<StanceJet>(jets.q), jets, felt, force);
}

// The cart's own forces: friction of the state, what is perceived of the rest.
struct CartForceJacobian {
  Eigen::Matrix<double, 2, 8> by_state, by_perceived;
  Eigen::Matrix<double, 2, kNumParameters> by_parameter;
};

// One output's derivatives by the state, by what is perceived, by s and by the parameters. own: of
// the cart's forces.
struct OutputJacobian {
  Eigen::Matrix<double, 1, 8> by_state = Eigen::Matrix<double, 1, 8>::Zero();
  Eigen::Matrix<double, 1, 8> by_ankle = by_state, by_foot = by_state;
  double by_step = 0.0;
  Eigen::Matrix<double, 1, kNumParameters> by_parameter;

  OutputJacobian(const StanceJet& output, const CartForceJacobian& own) {
    by_state.segment<2>(2) = output.v.head<2>().transpose();
    by_state.tail<4>() = output.v.segment<4>(kVelocityAt).transpose();
    by_ankle.segment<2>(2) = output.v.segment<2>(kAnkleAt).transpose();
    by_ankle.tail<2>() = output.v.segment<2>(kAnkleAt + 2).transpose();
    by_foot.segment<2>(2) = output.v.segment<2>(kFootAt).transpose();
    by_foot.tail<4>() = output.v.segment<4>(kFootAt + 2).transpose();
    by_step = output.v[kStepAt];
    const Eigen::RowVector2d by_force = output.v.segment<2>(kCartForceAt).transpose();
    by_state += by_force * own.by_state;
    by_foot += by_force * own.by_perceived;
    by_parameter = by_force * own.by_parameter;
    for (int i = 0; i < Ids::kCount; ++i) by_parameter[Ids::kIds[i]] += output.v[kParametersAt + i];
  }
};

// StandingTorque's derivatives, and the order of its parameters.
using StandingIds = StandingParameters<double>;
struct StandingJacobian {
  Eigen::Matrix2d by_angle, by_rate;
  Eigen::Matrix<double, 2, StandingIds::kCount> by_parameter;

  StandingJacobian(const SelfForce& self, const ParameterSet<double>& p,
                   const PendulumState<double>& state) {
    const Angles<double> angles(state.q);
    const auto& [s_th, c_th, s_ph, c_ph] = angles;
    const Vector3<double>& u0 = self.rest_direction;
    const Vector3<double> u{s_th, -c_th * s_ph, c_th * c_ph};
    const Vector3<double> by[2] = {{c_th, s_th * s_ph, -s_th * c_ph},
                                   {0.0, -c_th * c_ph, -c_th * s_ph}};
    const Vector3<double> twice[2][2] = {
        {{-s_th, c_th * s_ph, -c_th * c_ph}, {0.0, s_th * c_ph, s_th * s_ph}},
        {{0.0, s_th * c_ph, s_th * s_ph}, {0.0, c_th * s_ph, -c_th * c_ph}}};
    const double cosine = u.dot(u0), s2 = 1.0 - cosine * cosine;
    const double stretch = self.scale.stiffness * AngleOverSine(s2);
    const double slope = -2.0 * cosine * self.scale.stiffness * AngleOverSineSlope(s2);
    const Vector3<double> gains{p[kKpTheta], p[kKpPhi], 0.5 * (p[kKpTheta] + p[kKpPhi])};
    const Vector3<double> turned = cosine * u - u0, pull = gains.cwiseProduct(turned);
    const double hold = HoldPerComHeight(self), moment = hold * p[kComHeight];
    const Eigen::Vector2d flat = u0.head<2>();
    const double damping = self.scale.damping;
    by_rate.setZero();
    by_parameter.setZero();
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        const double nearer = by[j].dot(u0);
        const Vector3<double> more = gains.cwiseProduct(cosine * by[j] + nearer * u);
        by_angle(i, j) = -moment * flat.dot(twice[i][j].head<2>()) -
                         slope * nearer * pull.dot(by[i]) -
                         stretch * (more.dot(by[i]) + pull.dot(twice[i][j]));
      }
      const Vector3<double> lever = turned.cwiseProduct(by[i]);
      by_parameter(i, 0) = -stretch * (lever[0] + 0.5 * lever[2]);
      by_parameter(i, 1) = -stretch * (lever[1] + 0.5 * lever[2]);
      by_parameter(i, 4) = -hold * flat.dot(by[i].head<2>());
    }
    const double reach2 = c_th * c_th;
    by_rate(0, 0) = -damping * p[kKdTheta];
    by_rate(1, 1) = -damping * p[kKdPhi] * reach2;
    by_angle(1, 0) += 2.0 * damping * p[kKdPhi] * c_th * s_th * state.qd[3];
    by_parameter(0, 2) = -damping * state.qd[2];
    by_parameter(1, 3) = -damping * reach2 * state.qd[3];
  }
};

// By q and by the parameters of the tail.
void AddTailJacobianAtHip(const ScenePush& push, const SelfForce& self,
                          const ParameterSet<double>& p, int frame, double dt,
                          const Vector4<double>& q, SelfForce::Jacobian* jacobian) {
  if (!TailActs(push, frame)) return;
  constexpr Parameter kTail[] = {kTailGain, kTailTime, kTailExponent, kTailBase};
  using TailJet = ceres::Jet<double, 6>;
  ParameterSet<TailJet> parameters;
  for (int i = 0; i < 4; ++i) parameters[kTail[i]] = TailJet(p[kTail[i]], 2 + i);
  const Vector4<TailJet> angles{TailJet(q[0]), TailJet(q[1]), TailJet(q[2], 0), TailJet(q[3], 1)};
  const Vector4<TailJet> force =
      TailForceAtHip(push, parameters, self.body, Angles<TailJet>(angles), frame, dt);
  for (int row = 0; row < 4; ++row) {
    jacobian->by_state.row(row).segment<2>(2) += force[row].v.head<2>().transpose();
    for (int i = 0; i < 4; ++i) jacobian->by_parameter(row, kTail[i]) += force[row].v[2 + i];
  }
}

void AddPublishedFriction(SelfForce::Jacobian* jacobian) {
  for (int i = 0; i < 2; ++i) jacobian->by_state(i, 4 + i) = -kPublishedFriction;
}

}  // namespace

void NetForceJacobianOfStanding(const Scene& scene, const ModelOptions& options,
                                const SelfForce& self, const ParameterSet<double>& p, int person,
                                int frame, const PendulumState<double>& state,
                                SelfForce::Jacobian* jacobian, const Perceived<double>* perceived,
                                PerceivedJacobian* by_perceived) {
  if (by_perceived != nullptr) by_perceived->SetZero();
  jacobian->by_state.setZero();
  jacobian->by_previous.setZero();
  jacobian->by_parameter.setZero();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(jacobian);
  if (active != ActiveForces::kAll) return;
  const StandingJacobian torque(self, p, perceived != nullptr ? perceived->ankle : state);
  auto& by_felt = perceived != nullptr ? by_perceived->by_ankle : jacobian->by_state;
  for (int i = 0; i < 2; ++i) {
    jacobian->by_state(i, 4 + i) = -kHeldFast * self.body.mass;
    by_felt.row(2 + i).segment<2>(2) = torque.by_angle.row(i);
    by_felt.row(2 + i).tail<2>() = torque.by_rate.row(i);
    for (int k = 0; k < StandingIds::kCount; ++k) {
      jacobian->by_parameter(2 + i, StandingIds::kIds[k]) = torque.by_parameter(i, k);
    }
  }
  self.AddOwnJacobian(p, state, jacobian);
}

void NetForceJacobianOfStance(const Scene& scene, const ModelOptions& options,
                              const SelfForce& self, const ParameterSet<double>& p, int person,
                              int frame, const PendulumState<double>& state,
                              const Vector4<double>& a, SelfForce::Jacobian* jacobian,
                              StanceJacobian* stance, const Perceived<double>* late,
                              PerceivedJacobian* by_perceived) {
  const Perceived<double> perceived = late != nullptr ? *late : Perceived<double>(state);
  const PendulumState<double>& of_step = perceived.step;
  const Vector4<double> own =
      self.Friction(p, state.qd) + self.Balance(p, of_step, of_step.qd) + self.Linear(p, of_step);
  SelfForce::Jacobian of_friction, of_control;
  self.FrictionJacobian(p, state.qd, &of_friction);
  self.ControlJacobian(p, of_step, of_step.qd, &of_control);
  const CartForceJacobian of_own{
      of_friction.by_state.topRows<2>(), of_control.by_state.topRows<2>(),
      of_friction.by_parameter.topRows<2>() + of_control.by_parameter.topRows<2>()};
  const StanceForces<StanceJet> jets = JetsOfStance(self, p, state, perceived, own.head<2>());
  const OutputJacobian next(jets.next_step, of_own);
  stance->next_by_state = next.by_state;
  stance->next_by_ankle = next.by_ankle;
  stance->next_by_foot = next.by_foot;
  stance->next_by_step = next.by_step;
  stance->next_by_parameter = next.by_parameter;
  if (late == nullptr) stance->next_by_state += next.by_ankle + next.by_foot;
  if (by_perceived != nullptr) by_perceived->SetZero();
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
    const Eigen::Matrix<double, 1, 8> of_cart = state.step * of_own.by_perceived.row(i);
    jacobian->by_parameter.row(i) =
        state.step * of_own.by_parameter.row(i) - after * ground.by_parameter;
    stance->by_step[i] = own[i] - after * ground.by_step;
    const OutputJacobian torque(jets.torque[i], of_own);
    jacobian->by_state.row(2 + i) = torque.by_state;
    if (late == nullptr) {
      jacobian->by_state.row(i) += of_cart;
      jacobian->by_state.row(2 + i) += torque.by_ankle + torque.by_foot;
    } else {
      by_perceived->by_step.row(i) = of_cart;
      by_perceived->by_step.row(2 + i) = torque.by_foot;
      by_perceived->by_ankle.row(2 + i) = torque.by_ankle;
    }
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
