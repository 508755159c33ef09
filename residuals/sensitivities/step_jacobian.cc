// residuals: forces, their derivatives, and those of the equations of motion, put together.
#include "residuals/sensitivities/step_jacobian.h"

#include "residuals/sensitivities/learned_pair_jacobian.h"
#include "residuals/sensitivities/net_force_jacobian.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

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
      PairJacobian pair =
          ComputePairJacobian(options_.interaction, options_.interaction_network.get(), two,
                              forces_.Parameters(0), forces_.state(n), forces_.state(j));
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

}  // namespace pushid
