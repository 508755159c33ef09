// residuals: the chain rule through feet that stand and step.
#include "residuals/sensitivities/stance_sensitivities.h"

#include <ceres/jet.h>

#include "residuals/lanes/person_lanes.h"
#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {
namespace {

using Ids = StanceParameters<double>;

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

StanceSensitivities::Hip::Hip(const PosedPendulum<double>& state, const double* rows)
    : at{state.angles.s_th,
         state.angles.c_th,
         state.angles.s_ph,
         state.angles.c_ph,
         {state.qd[0], state.qd[1], state.qd[2], state.qd[3]}},
      by_column(rows) {}

StanceSensitivities::StanceSensitivities(const std::vector<std::vector<ColumnEntry>>& entries,
                                         int num_columns)
    : of_forces_(4, num_columns) {
  for (const std::vector<ColumnEntry>& of_person : entries) {
    RowMajorMatrix& rows =
        by_parameter_.emplace_back(RowMajorMatrix::Zero(Ids::kCount, num_columns));
    for (const ColumnEntry& entry : of_person) {
      for (int i = 0; i < Ids::kCount; ++i) {
        if (entry.parameter == Ids::kIds[i]) rows(i, entry.column) += entry.derivative;
      }
    }
  }
}

void StanceSensitivities::Advance(const SelfForce& self, const ParameterSet<double>& p, int person,
                                  const Hip& ankle, const Hip& step, const FeetState<double>& feet,
                                  const double* by_feet, bool acts, double* next_by_feet,
                                  ForceColumns* by_column) {
  StanceJetInputs in;
  in.body = self.standing;
  in.feet[0] = feet.apart[0], in.feet[1] = feet.apart[1];
  in.feet[2] = feet.clock, in.feet[3] = feet.swing_time;
  in.swings = feet.swings;
  in.landed = feet.landed;
  in.fresh = feet.fresh;
  in.ankle = ankle.at;
  in.step = step.at;
  for (int i = 0; i < Ids::kCount; ++i) in.parameters[i] = p[Ids::kIds[i]];
  in.columns = of_forces_.cols();
  in.by_feet = by_feet;
  // The place, which comes first, is not among what feet know.
  in.by_ankle = ankle.by_column + 2 * in.columns;
  in.by_step = step.by_column != ankle.by_column ? step.by_column + 2 * in.columns : nullptr;
  in.by_parameter = by_parameter_[static_cast<size_t>(person)].data();
  BestPersonLanes().stance_jet(in, of_forces_.data(), next_by_feet);
  if (!acts) return;
  by_column->topRows<2>() += (kHeldFast * self.body.mass) * of_forces_.topRows<2>();
  by_column->bottomRows<2>() += of_forces_.bottomRows<2>();
}

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
                              int frame, const PosedPendulum<double>& state,
                              SelfForce::Jacobian* jacobian) {
  jacobian->SetZero();
  jacobian->by_parameter.col(kComHeight).setZero();  // not among those; the table's body has it
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(jacobian);
  if (active != ActiveForces::kAll) return;
  for (int i = 0; i < 2; ++i) jacobian->by_state(i, 4 + i) = -kHeldFast * self.body.mass;
  self.AddOwnJacobian(p, state, jacobian);
  if (options.push_tail == PushTail::kNone) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    AddTailJacobianAtHip(push, self, p, frame, scene.dt, state.q, jacobian);
  }
}

}  // namespace pushid
