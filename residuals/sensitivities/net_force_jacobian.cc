// residuals: derivatives of what acts on a person alone, late control included.
#include "residuals/sensitivities/net_force_jacobian.h"

#include "residuals/sensitivities/body_sensitivities.h"

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

}  // namespace pushid
