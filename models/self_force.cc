// models: Jacobians of the self force with the laws that a user brings.
#include "models/self_force.h"

namespace pushid {

void SelfForce::AddOwnJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                               Jacobian* jacobian) const {
  int column = kFirstOwnParameter;
  for (const auto& law : laws) {
    const int own = static_cast<int>(law->parameters().size());
    ForceLaw::Inputs inputs = ForceLaw::Inputs::Zero();
    inputs.head<8>() << state.q, state.qd;
    for (int i = 0; i < own; ++i) inputs[8 + i] = p[column + i];
    ForceLaw::Jacobian by_input;
    law->Force({body, posture}, inputs, &by_input);
    jacobian->by_state += by_input.leftCols<8>();
    jacobian->by_parameter.middleCols(column, own) += by_input.middleCols(8, own);
    column += own;
  }
}

void SelfForce::TotalJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                              const Vector4<double>& qd_previous, Jacobian* jacobian) const {
  MotionJacobian(p, state, qd_previous, jacobian);
  AddOwnJacobian(p, state, jacobian);
}

void SelfForce::EffortJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                               const Vector4<double>& qd_previous, Jacobian* jacobian) const {
  ControlJacobian(p, state, qd_previous, jacobian);
  AddOwnJacobian(p, state, jacobian);
}

}  // namespace pushid
