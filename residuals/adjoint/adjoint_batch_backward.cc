// residuals: the way back over the rollouts of a batch.
#include "residuals/adjoint/adjoint_batch.h"
#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {

double AdjointGradient::Batch::AddResidual(int column, int frame, Adjoint* adjoint) const {
  const Walker& walker = walkers_[column];
  FrameJacobian<10> jacobian;
  const FrameVector<double> r =
      MovingRodResidualWithJacobian(walker.body(), Parameters(column)[kRodLift], walker.path[frame],
                                    walker.Measured(frame, rod_.has_value()), sigmas_, &jacobian);
  const Eigen::Matrix<double, 10, 1> gradient =
      walker.weight * walker.weight * (jacobian.transpose() * r);
  adjoint->state += gradient.head<8>();
  adjoint->rod += gradient[8];
  return gradient[9];
}

AdjointGradient::Batch::ForceAdjoint AdjointGradient::Batch::StepBack(
    int column, int step, const Eigen::VectorXd* by_rod, Adjoint* adjoint,
    ParameterSet<double>* by_parameter) const {
  const Walker& walker = walkers_[column];
  const ParameterSet<double>& p = Parameters(column);
  const double dt = walker.scene().dt;
  const PendulumState<double>& state = walker.path[step];
  const Vector4<double>& before = walker.VelocityBefore(step);
  const Body body = BodyNow(walker.body(), state.rod, 0.0);
  State& s = adjoint->state;
  Eigen::Map<Eigen::Matrix<double, kNumParameters, 1>> sum(by_parameter->data());

  const Vector4<double> g = s.tail<4>() + dt * s.head<4>();
  const Vector4<double> f = dt * (InverseMassMatrix(body, state.q) * g);
  SelfForce::Jacobian jacobian;
  NetForceJacobian(walker.scene(), options_, walker.self, p, walker.person, step, state, before,
                   &jacobian);
  const Matrix4<double> rigid =
      InverseDynamicsJacobian(body, Angles<double>(state.q), state.qd, walker.acceleration[step]);
  jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
  jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
  s.tail<4>() = g;
  s += jacobian.by_state.transpose() * f;
  sum += jacobian.by_parameter.transpose() * f;
  Eigen::Vector2d by_previous = jacobian.by_previous.cwiseProduct(f.head<2>());
  ForceAdjoint by_force;
  if (ForcesAt(walker.scene(), options_.push, walker.person, step) == ActiveForces::kAll) {
    by_force = {f, f};
  }

  if (by_rod != nullptr) {
    adjoint->rod -= f.dot(InverseDynamicsByBody(body, Angles<double>(state.q), state.qd,
                                                walker.acceleration[step])
                              .col(1)) /
                    body.rod_length;
    adjoint->rod += (*by_rod)[RodShape::kRodInput] / kNetworkRod;
    const Vector4<double> seen =
        by_rod->segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * walker.body().mass);
    walker.self.TotalJacobian(p, state, before, &jacobian);
    s.tail<6>() += by_rod->head<6>().cwiseProduct(MotionInputScales());
    s += jacobian.by_state.transpose() * seen;
    sum += jacobian.by_parameter.transpose() * seen;
    by_previous += jacobian.by_previous.cwiseProduct(seen.head<2>());
    by_force.network += seen;
  }

  s.segment<2>(4) += adjoint->owed;
  adjoint->owed.setZero();
  if (walker.self.cart_derivative) {
    if (step > 0) {
      adjoint->owed = by_previous;
    } else {
      s.segment<2>(4) += by_previous;
    }
  }
  return by_force;
}

void AdjointGradient::Batch::Backward(ParameterSet<double>* by_parameter, double* by_weight) {
  std::vector<Adjoint> adjoints(walkers_.size());  // of the frame after the step
  for (int step = columns_.num_steps() - 1; step >= 0; --step) {
    RodBack(step, &adjoints, by_parameter);
    const int people = columns_.active(step);
    forces_.setZero(4, people);
    received_.setZero(4, static_cast<Eigen::Index>(walkers_.size()));
    Eigen::VectorXd by_rod;
    for (int column = 0; column < people; ++column) {
      if (!Going(walkers_[column], step)) continue;
      if (rod_) by_rod = rod_inputs_.col(column);
      const ForceAdjoint by_force =
          StepBack(column, step, rod_ ? &by_rod : nullptr, &adjoints[column], by_parameter);
      forces_.col(column) = by_force.network;
      received_.col(column) = by_force.received;
    }
    ForcesBack(step, &adjoints, by_parameter);
  }
  if (by_weight == nullptr) return;
  if (network_) network_->AddWeightGradient(by_weight);
  if (rod_) rod_->AddWeightGradient(by_weight + options_.learned->rod_at());
  if (others_) others_->AddWeightGradient(by_weight);
}

void AdjointGradient::Batch::RodBack(int step, std::vector<Adjoint>* adjoints,
                                     ParameterSet<double>* by_parameter) {
  const int people = columns_.active(step);
  rod_velocities_.setZero(people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    Adjoint& adjoint = (*adjoints)[column];
    (*by_parameter)[kRodLift] += AddResidual(column, step + 1, &adjoint);
    rod_velocities_[column] = walker.scene().dt * adjoint.rod;
  }
  if (rod_) rod_->Backward(step, rod_velocities_, &rod_inputs_);
}

void AdjointGradient::Batch::ForcesBack(int step, std::vector<Adjoint>* adjoints,
                                        ParameterSet<double>* by_parameter) {
  if (network_) {
    network_->Backward(step, forces_, &inputs_);
    for (int column = 0; column < columns_.active(step); ++column) {
      (*adjoints)[column].state.tail<6>() +=
          inputs_.col(column).head<6>().cwiseProduct(MotionInputScales());
    }
  }
  if (!others_) return;
  SetStates(step);
  by_state_.setZero(8, static_cast<Eigen::Index>(walkers_.size()));
  others_->Backward(step, now_, received_, &by_state_, by_parameter);
  for (size_t column = 0; column < walkers_.size(); ++column) {
    (*adjoints)[column].state += by_state_.col(static_cast<Eigen::Index>(column));
  }
}

}  // namespace pushid
