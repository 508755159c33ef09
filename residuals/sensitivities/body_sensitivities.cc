// residuals: derivatives of what acts on a person alone, late control and the table's masses
// included.
#include "residuals/sensitivities/body_sensitivities.h"

#include <ceres/jet.h>

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

constexpr Parameter kMasses[] = {kCartMassShare, kGyrationRadius, kComHeight};
constexpr int kNumMasses = 3;
using BodyJet = ceres::Jet<double, kNumMasses>;

// Of functions of the table's masses.
ParameterSet<BodyJet> MassJets(const ParameterSet<double>& p) {
  ParameterSet<BodyJet> jets{};
  for (int k = 0; k < kNumMasses; ++k) jets[kMasses[k]] = BodyJet(p[kMasses[k]], k);
  return jets;
}

void AddHoldOfTable(const SelfForce& self, const ParameterSet<double>& p,
                    SelfForce::Jacobian* jacobian) {
  const Eigen::Matrix<BodyJet, 2, 1> hold = HoldOfTable(self, MassJets(p));
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < kNumMasses; ++k) jacobian->by_parameter(2 + i, kMasses[k]) += hold[i].v[k];
  }
}

}  // namespace

// -d(M a + C + g_n / g G)/d(the table's masses) at fixed acceleration a.
void SubtractInverseDynamicsByMasses(const Body& body, const ParameterSet<double>& p,
                                     const PendulumState<double>& state, const Vector4<double>& a,
                                     double gravity, SelfForce::Jacobian* jacobian) {
  const BodyOf<BodyJet> jets = TableBody(body, MassJets(p));
  const PendulumState<BodyJet> still{state.q.cast<BodyJet>(), state.qd.cast<BodyJet>()};
  const Vector4<BodyJet> value =
      InverseDynamics<BodyJet>(jets, still, a.cast<BodyJet>()) +
      BodyJet(gravity / kGravity - 1.0) * Gravity<BodyJet>(jets, still.q);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < kNumMasses; ++k) jacobian->by_parameter(i, kMasses[k]) -= value[i].v[k];
  }
}

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
    if (active == ActiveForces::kAll) AddHoldOfTable(self, p, jacobian);
  }
  if (options.push_tail == PushTail::kNone || active != ActiveForces::kAll) return;
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person) {
      AddTailJacobian(push, p, frame, scene.dt, &jacobian->by_parameter);
    }
  }
}

}  // namespace pushid
