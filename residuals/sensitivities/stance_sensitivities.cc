// residuals: the chain rule through feet that stand and step.
#include "residuals/sensitivities/stance_sensitivities.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

using Ids = StanceParameters<double>;

// Inputs of the jets: the feet, the hip as ankles and steps perceive it (its place, its velocity
// and the cart's), then the parameters. Where nothing is late both perceive the same, and share
// their inputs.
constexpr int kPerceived = 6, kAnkleAt = kFeetStates;

template <bool kLate>
struct StanceInputs {
  static constexpr int kFootAt = kLate ? kAnkleAt + kPerceived : kAnkleAt;
  static constexpr int kParametersAt = kFootAt + kPerceived;
  static constexpr int kCount = kParametersAt + Ids::kCount;
  using Jet = ceres::Jet<double, kCount>;
};

// The hip over the feet, and its derivatives by [two angles, qd].
struct PerceivedHip {
  using Jet = ceres::Jet<double, kPerceived>;
  double value[kPerceived];
  Eigen::Matrix<double, kPerceived, kPerceived, Eigen::RowMajor> by_state;

  PerceivedHip(const SelfForce& self, const PendulumState<double>& state) {
    Vector4<Jet> q = Vector4<Jet>::Zero(), qd;
    for (int i = 0; i < 2; ++i) q[2 + i] = Jet(state.q[2 + i], i);
    for (int i = 0; i < 4; ++i) qd[i] = Jet(state.qd[i], 2 + i);
    const HipOverFeet<Jet> hip(self, Angles<Jet>(q), qd);
    for (int i = 0; i < kPerceived; ++i) {
      const Jet& jet = (i < 2 ? hip.place : i < 4 ? hip.velocity : hip.cart)[i % 2];
      value[i] = jet.a;
      by_state.row(i) = jet.v.transpose();
    }
  }

  // As inputs of jets from `first` on.
  template <typename T>
  HipOverFeet<T> Inputs(int first) const {
    HipOverFeet<T> hip;
    for (int i = 0; i < 2; ++i) {
      hip.place[i] = T(value[i], first + i);
      hip.velocity[i] = T(value[2 + i], first + 2 + i);
      hip.cart[i] = T(value[4 + i], first + 4 + i);
    }
    return hip;
  }
};

template <bool kLate>
auto JetsOfStance(const SelfForce& self, const ParameterSet<double>& p,
                  const FeetState<double>& feet, const PerceivedHip& ankle,
                  const PerceivedHip& step) {
  using Inputs = StanceInputs<kLate>;
  using Jet = typename Inputs::Jet;
  FeetState<Jet> jets;
  for (int i = 0; i < 2; ++i) jets.apart[i] = Jet(feet.apart[i], i);
  jets.clock = Jet(feet.clock, 2);
  jets.swing_time = Jet(feet.swing_time, 3);
  jets.swings = feet.swings;
  jets.landed = feet.landed;
  int input = Inputs::kParametersAt;
  // In the order of kIds, which is that of the members.
  const StanceParameters<Jet> parameters([&](Parameter id) { return Jet(p[id], input++); });
  return StanceStep<Jet>(self, parameters, jets, ankle.Inputs<Jet>(kAnkleAt),
                         step.Inputs<Jet>(Inputs::kFootAt).Capture(self))
      .Run();
}

// One output's derivatives, times `factor`, into row `row` of each.
template <bool kLate, typename ByState, typename ByFeet, typename ByParameter>
void SetRow(const typename StanceInputs<kLate>::Jet& output, double factor, int row,
            const PerceivedHip& ankle, const PerceivedHip& step, ByState* by_ankle,
            ByState* by_foot, ByFeet* by_feet, ByParameter* by_parameter) {
  using Inputs = StanceInputs<kLate>;
  const auto set = [&](const PerceivedHip& hip, ByState* by, int first) {
    by->row(row).template tail<kPerceived>().noalias() =
        (factor * output.v.template segment<kPerceived>(first).transpose()) * hip.by_state;
  };
  set(ankle, by_ankle, kAnkleAt);
  if (kLate) set(step, by_foot, Inputs::kFootAt);
  by_feet->row(row) = factor * output.v.template head<kFeetStates>().transpose();
  for (int i = 0; i < Ids::kCount; ++i) {
    (*by_parameter)(row, Ids::kIds[i]) = factor * output.v[Inputs::kParametersAt + i];
  }
}

// by_ankle, by_foot: of the force; where nothing is late, by_ankle is by the state.
template <bool kLate>
void StanceRows(const SelfForce& self, const ParameterSet<double>& p,
                const PendulumState<double>& state, const Perceived<double>& perceived, bool acts,
                Eigen::Matrix<double, 4, 8>* by_ankle, Eigen::Matrix<double, 4, 8>* by_foot,
                SelfForce::Jacobian* jacobian, StanceJacobian* stance) {
  const PerceivedHip ankle(self, perceived.ankle);
  const PerceivedHip step = kLate ? PerceivedHip(self, perceived.step) : ankle;
  const auto jets = JetsOfStance<kLate>(self, p, state.feet, ankle, step);
  auto* next_by_ankle = kLate ? &stance->next_by_ankle : &stance->next_by_state;
  const typename StanceInputs<kLate>::Jet* next[] = {&jets.next.apart[0], &jets.next.apart[1],
                                                     &jets.next.clock, &jets.next.swing_time};
  for (int i = 0; i < kFeetStates; ++i) {
    SetRow<kLate>(*next[i], 1.0, i, ankle, step, next_by_ankle, &stance->next_by_foot,
                  &stance->next_by_feet, &stance->next_by_parameter);
  }
  if (!acts) return;
  const double ground = kHeldFast * self.body.mass;
  for (int i = 0; i < 4; ++i) {
    SetRow<kLate>(i < 2 ? jets.velocity[i] : jets.torque[i - 2], i < 2 ? ground : 1.0, i, ankle,
                  step, by_ankle, by_foot, &stance->by_feet, &jacobian->by_parameter);
  }
  for (int i = 0; i < 2; ++i) jacobian->by_state(i, 4 + i) -= ground;
}

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
                              SelfForce::Jacobian* jacobian, StanceJacobian* stance,
                              const Perceived<double>* late, PerceivedJacobian* by_perceived) {
  if (by_perceived != nullptr) by_perceived->SetZero();
  stance->SetZero();
  jacobian->by_state.setZero();
  jacobian->by_previous.setZero();
  jacobian->by_parameter.setZero();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  const bool acts = active == ActiveForces::kAll;
  if (late != nullptr) {
    StanceRows<true>(self, p, state, *late, acts, &by_perceived->by_ankle, &by_perceived->by_step,
                     jacobian, stance);
  } else {
    StanceRows<false>(self, p, state, Perceived<double>(state), acts, &jacobian->by_state, nullptr,
                      jacobian, stance);
  }
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(jacobian);
  if (!acts) return;
  self.AddOwnJacobian(p, state, jacobian);
  if (options.push_tail == PushTail::kNone) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    AddTailJacobianAtHip(push, self, p, frame, scene.dt, state.q, jacobian);
  }
}

}  // namespace pushid
