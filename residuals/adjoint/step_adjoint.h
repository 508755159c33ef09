// residuals: one step of the model backwards: from the adjoints of what it made to those of what it
// was made of. With the outputs y, the inputs x and y^ = d(cost)/dy,
//   x^ = (dy/dx)' y^ = d(y^ . y)/dx:
// the derivatives of one number, by jets through the model's own templates. All add to what is
// there.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "models/step.h"
#include "residuals/frame_residual.h"

namespace pushid {

// Derivatives of the cost by one person's state at a frame.
struct StateAdjoint {
  Eigen::Matrix<double, 8, 1> state = Eigen::Matrix<double, 8, 1>::Zero();  // [q, qd]
  double rod = 0.0;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();  // the cart's velocity one frame earlier
};

// One person in one step, of sliding feet without a delay and of a body that is a point.
struct PersonStep {
  const Scene& scene;
  const ModelOptions& options;
  const SelfForce& self;
  const ParameterSet<double>& p;
  int person, frame;
  const PendulumState<double>& state;
  const Vector4<double>& before;  // the velocity one frame earlier
};

// by_force: the adjoint of the net force, which gave the person this acceleration; by_effort: that
// of SelfForce::Effort, null where nothing sees it. acting: the parameters of which one is asked
// for.
void PersonBack(const PersonStep& step, const Vector4<double>& acceleration,
                const Vector4<double>& by_force, const Vector4<double>* by_effort,
                const std::vector<Parameter>& acting, StateAdjoint* adjoint,
                ParameterSet<double>* by_parameter);

// Two people who act on each other: by_n and by_j, the adjoints of what each gets; by_gate: that of
// the gate of what is learned (PairGate), null where it does not act; by_inputs: those of what a
// learned interaction sees (PairInputs), of n who meets j and of j who meets n, no columns where it
// is not asked. Returns those of [q, qd] of n, then of j.
using PairAdjoint = Eigen::Matrix<double, 16, 1>;
PairAdjoint PairBack(const ModelOptions& options, const Pair& pair, const ParameterSet<double>& p,
                     const PendulumState<double>& n, const PendulumState<double>& j,
                     const Vector4<double>& by_n, const Vector4<double>& by_j,
                     const double* by_gate, const Eigen::MatrixXd& by_inputs,
                     ParameterSet<double>* by_parameter);

// Half the squared residual of a person at a frame, times weight squared.
void FrameBack(const Body& body, const PendulumState<double>& state, const MeasuredFrame& measured,
               const ResidualSigmas& sigmas, double weight, StateAdjoint* adjoint);

}  // namespace pushid
