// residuals: derivatives of what acts on a person alone, late control included.
#include "residuals/sensitivities/net_force_jacobian.h"

#include "models/dual.h"
#include "residuals/sensitivities/learned_pair_jacobian.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {
namespace {

// What balances on what was perceived: rows of the cart by steps, those of the angles by ankles.
void LateJacobian(const SelfForce& self, const ParameterSet<double>& p,
                  const PendulumState<double>& state, const Perceived<double>& perceived,
                  const Vector4<double>& previous, SelfForce::Jacobian* jacobian,
                  PerceivedJacobian* by_perceived) {
  SelfForce::Jacobian of_cart, of_angles;
  self.ControlJacobian(p, perceived.step, previous, &of_cart);
  self.ControlJacobian(p, perceived.ankle, previous, &of_angles);
  self.FrictionJacobian(p, state.qd, jacobian);
  self.AddOwnJacobian(p, state, jacobian);
  by_perceived->by_step.topRows<2>() = of_cart.by_state.topRows<2>();
  by_perceived->by_ankle.bottomRows<2>() = of_angles.by_state.bottomRows<2>();
  jacobian->by_previous = of_cart.by_previous;
  jacobian->by_parameter.topRows<2>() += of_cart.by_parameter.topRows<2>();
  jacobian->by_parameter.bottomRows<2>() += of_angles.by_parameter.bottomRows<2>();
}

using BodyDual = Dual<double, kNumBodyParameters>;

ParameterSet<BodyDual> Duals(const ParameterSet<double>& p) {
  ParameterSet<BodyDual> duals{};
  for (int k = 0; k < kNumBodyParameters; ++k) {
    duals[kBodyParameters[k]] = BodyDual::Input(p[kBodyParameters[k]], k);
  }
  return duals;
}

}  // namespace

void NetForceJacobian(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                      const ParameterSet<double>& p, int person, int frame,
                      const PendulumState<double>& state, const Vector4<double>& previous,
                      SelfForce::Jacobian* jacobian, const Perceived<double>* perceived,
                      PerceivedJacobian* by_perceived) {
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (by_perceived != nullptr) by_perceived->SetZero();
  // Of no person's own forces elsewhere, and so never cleared (SelfJacobian).
  if (options.body == BodyModel::kTable) jacobian->by_parameter.col(kComHeight).setZero();
  switch (active) {
    case ActiveForces::kAll:
      if (perceived == nullptr) {
        self.TotalJacobian(p, state, previous, jacobian);
      } else {
        LateJacobian(self, p, state, *perceived, previous, jacobian, by_perceived);
      }
      break;
    case ActiveForces::kPushAndFriction:
      self.FrictionJacobian(p, state.qd, jacobian);
      break;
    case ActiveForces::kPushOnly:
      jacobian->SetZero();
      break;
  }
  if (options.body == BodyModel::kTable) {
    jacobian->by_parameter.col(kPushGain) += PushForceAt(scene, person, frame);
    if (active == ActiveForces::kAll) {
      const auto hold = HoldOfTableJacobian(self, p);
      for (int k = 0; k < kNumBodyParameters; ++k) {
        jacobian->by_parameter.col(kBodyParameters[k]).tail<2>() += hold.col(k);
      }
    }
  }
  if (options.push_tail == PushTail::kNone || active != ActiveForces::kAll) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person) {
      AddTailJacobian(push, self.body.mass, p, frame, scene.dt, &jacobian->by_parameter);
    }
  }
}

void StepJacobian::Begin(const std::vector<PendulumState<double>>& states) {
  forces_.Update(states.data());
  forces_.PrepareAll();
}

Vector4<double> StepJacobian::Velocity(int frame, int person,
                                       Eigen::Matrix<double, 4, 8>* by_state) {
  const Body& body = scene_.people[person].body;
  const SelfForce& self = forces_.self(person);
  const ParameterSet<double>& p = forces_.Parameters(person);
  const PendulumState<double>& state = forces_.state(person);
  const NetForce<double> force = forces_.On(person, frame, state.qd);
  const Vector4<double> a = forces_.AccelerationOf(person, force);
  SelfForce::Jacobian jacobian;
  NetForceJacobian(scene_, options_, self, p, person, frame, state, state.qd, &jacobian);
  const Body now = DynamicBody(options_, body, p, false);
  const GroundStep& ground = scene_.ground.StepAt(frame);
  const Matrix4<double> rigid = InverseDynamicsJacobian(
      now, force.angles, state.qd, Vector4<double>(a + ground.acceleration), ground.gravity);
  Eigen::Matrix<double, 4, 8> of_force = jacobian.by_state;
  of_force.middleCols<2>(2) -= rigid.leftCols<2>();
  of_force.middleCols<2>(6) -= rigid.rightCols<2>();
  if (options_.interaction.Any() &&
      ForcesAt(scene_, options_.push, person, frame) == ActiveForces::kAll) {
    for (const auto& [n, j] : forces_.acting()) {
      if (n != person && j != person) continue;
      const Pair two = forces_.pairs().Of(n, j);
      PairJacobian pair = ComputePairJacobian(options_.interaction, two, forces_.Parameters(0),
                                              forces_.state(n), forces_.state(j));
      if (options_.interaction.learned) {
        const LearnedTerms& learned = *options_.learned;
        AddLearnedPairJacobian(learned.pair, learned.weights.data() + learned.pair_at(), two,
                               forces_.Parameters(0), forces_.state(n), forces_.state(j), &pair,
                               nullptr);
      }
      const int at = n == person ? 0 : 1;
      of_force += pair.by_states.block<4, 8>(4 * at, 8 * at);
    }
  }
  *by_state = scene_.dt * InverseMassMatrix(now, force.angles, now.mass) * of_force;
  by_state->rightCols<4>() += Matrix4<double>::Identity();
  return state.qd + scene_.dt * a;
}

BodyByParameters BodyJacobian(const ModelOptions& options, const Body& body,
                              const ParameterSet<double>& p, bool holds_fast) {
  BodyByParameters by = BodyByParameters::Zero();
  if (holds_fast) {
    by(1, 0) = 1.0 / p[kComHeight];
  } else if (options.body == BodyModel::kTable) {
    const BodyOf<BodyDual> of = TableBody(body, Duals(p));
    by << of.point_share.v.transpose() / of.point_share.a,
        of.pendulum_ratio.v.transpose() / of.pendulum_ratio.a;
  }
  return by;
}

Eigen::Matrix<double, 2, kNumBodyParameters> HoldOfTableJacobian(const SelfForce& self,
                                                                 const ParameterSet<double>& p) {
  const Eigen::Matrix<BodyDual, 2, 1> hold = HoldOfTable(self, Duals(p));
  Eigen::Matrix<double, 2, kNumBodyParameters> by;
  by << hold[0].v.transpose(), hold[1].v.transpose();
  return by;
}

}  // namespace pushid
