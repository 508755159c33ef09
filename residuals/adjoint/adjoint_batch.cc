// residuals: rollouts side by side, forwards and backwards.
#include "residuals/adjoint/adjoint_batch.h"

#include <algorithm>

namespace pushid {
namespace {

int Frames(const AdjointRecording& r) {
  const int frames = r.recording->num_frames();
  return r.horizon > 0 ? std::min(r.horizon, frames) : frames;
}

LockstepColumns ColumnsOf(const std::vector<AdjointRecording>& all,
                          const std::vector<int>& recordings) {
  std::vector<int> steps;
  for (int index : recordings) {
    steps.insert(steps.end(), all[index].recording->num_people(),
                 std::max(0, Frames(all[index]) - 1));
  }
  return LockstepColumns(steps);
}

}  // namespace

MeasuredFrame AdjointGradient::Batch::Walker::Measured(int frame) const {
  return {recording->hip[person][frame], recording->states[person][frame],
          recording->Weight(person, frame)};
}

AdjointGradient::Batch::Batch(const std::vector<AdjointRecording>& all,
                              const std::vector<int>& recordings, const ModelOptions& options,
                              const ResidualSigmas& sigmas, const VectorKernels& kernels)
    : options_(options), sigmas_(sigmas), columns_(ColumnsOf(all, recordings)) {
  std::vector<double> masses;
  for (int index : recordings) {
    const AdjointRecording& r = all[index];
    const std::vector<SelfForce> self = SelfForces(r.recording->scene, options);
    const int place = static_cast<int>(horizon_.size()), frames = Frames(r);
    horizon_.push_back(frames);
    for (int n = 0; n < r.recording->num_people(); ++n) {
      walkers_.push_back({r.recording, index, place, n, r.weight, self[n],
                          std::vector<PendulumState<double>>(frames),
                          std::vector<Vector4<double>>(frames)});
      if (frames > 0) walkers_.back().path[0] = r.recording->scene.people[n].start;
      masses.push_back(self[n].body.mass);
    }
  }
  const LearnedTerms& network = *options_.learned;
  if (network.shape.any()) network_.emplace(network.shape, kernels, columns_, masses);
  if (network.rod.moves()) rod_.emplace(network.rod, kernels, columns_);
}

double AdjointGradient::Batch::Forward(const ParameterSet<double>& p, const double* weights,
                                       std::vector<RolloutStatus>* status) {
  end_ = horizon_;
  if (network_) network_->Start(weights);
  if (rod_) rod_->Start(weights + options_.learned->rod_at());
  for (int step = 0; step < columns_.num_steps(); ++step) {
    SetForces(step);
    SetRodVelocities(p, step);
    Step(p, step, status);
  }
  return Cost(p[kRodLift]);
}

void AdjointGradient::Batch::SetForces(int step) {
  const int people = columns_.active(step);
  forces_.setZero(4, people);
  if (!network_) return;
  const NetworkShape& shape = options_.learned->shape;
  VectorX<double> u(shape.num_inputs());
  inputs_.setZero(shape.num_inputs(), people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    SetMotionInputs<double>(state.q[2] - walker.self.posture[0],
                            state.q[3] - walker.self.posture[1], state.qd, &u);
    if (shape.rod_input) u[kMotionInputs] = state.rod / kNetworkRod;
    inputs_.col(column) = u;
  }
  network_->Forward(step, inputs_, &forces_);
}

void AdjointGradient::Batch::SetRodVelocities(const ParameterSet<double>& p, int step) {
  const int people = columns_.active(step);
  rod_velocities_.setZero(people);
  if (!rod_) return;
  RodLayers<double> layers(options_.learned->rod);
  rod_inputs_.setZero(RodShape::kInputs, people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    Vector4<double> force = walker.self.Total(p, state, walker.VelocityBefore(step));
    force += forces_.col(column);
    force.tail<2>() -= walker.self.hold;
    SetRodInputs<double>(state.q[2] - walker.self.posture[0], state.q[3] - walker.self.posture[1],
                         state.qd, force, state.rod, walker.body().mass, &layers);
    rod_inputs_.col(column) = layers.inputs;
  }
  rod_->Forward(step, rod_inputs_, &rod_velocities_);
}

void AdjointGradient::Batch::Step(const ParameterSet<double>& p, int step,
                                  std::vector<RolloutStatus>* status) {
  for (int column = 0; column < columns_.active(step); ++column) {
    Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    const Vector4<double> force =
        NetForceAt<double>(walker.scene(), options_, walker.self, p, walker.person, step, state,
                           walker.VelocityBefore(step), {}, forces_.col(column))
            .Total();
    walker.acceleration[step] = Acceleration(BodyNow(walker.body(), state.rod, 0.0), state, force);
    PendulumState<double>& next = walker.path[step + 1];
    next = pushid::Step(state, walker.acceleration[step], walker.scene().dt);
    next.rod += walker.scene().dt * rod_velocities_[column];
    const std::string_view outside = OutsideDomain(walker.body(), next);
    if (outside.empty()) continue;
    (*status)[walker.index] = {false, step + 1, walker.person, outside};
    end_[walker.place] = step + 1;
    if (!network_) continue;
    for (int other = 0; other < columns_.active(step); ++other) {
      if (walkers_[other].place == walker.place) network_->Forget(step, other);
    }
  }
}

double AdjointGradient::Batch::Cost(double lift) const {
  double cost = 0.0;
  for (const Walker& walker : walkers_) {
    for (int t = 1; t < end_[walker.place]; ++t) {
      const PendulumState<double>& state = walker.path[t];
      const FrameVector<double> r =
          walker.weight * FrameResidual<double>(BodyNow(walker.body(), state.rod, lift), state,
                                                walker.Measured(t), sigmas_);
      cost += 0.5 * r.squaredNorm();
    }
  }
  return cost;
}

double AdjointGradient::Batch::AddResidual(const Walker& walker, int frame, double lift,
                                           Adjoint* adjoint) const {
  Eigen::Matrix<double, kFrameResiduals, 10> jacobian;
  const FrameVector<double> r = MovingRodResidualWithJacobian(
      walker.body(), lift, walker.path[frame], walker.Measured(frame), sigmas_, &jacobian);
  const Eigen::Matrix<double, 10, 1> gradient =
      walker.weight * walker.weight * (jacobian.transpose() * r);
  adjoint->state += gradient.head<8>();
  adjoint->rod += gradient[8];
  return gradient[9];
}

Vector4<double> AdjointGradient::Batch::StepBack(const Walker& walker,
                                                 const ParameterSet<double>& p, int step,
                                                 const Eigen::VectorXd* by_rod, Adjoint* adjoint,
                                                 ParameterSet<double>* by_parameter) const {
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
  Vector4<double> by_network = Vector4<double>::Zero();
  if (ForcesAt(walker.scene(), options_.push, walker.person, step) == ActiveForces::kAll) {
    by_network = f;
  }

  if (by_rod != nullptr) {
    adjoint->rod -= f.dot(InverseDynamicsByRod(body, state, walker.acceleration[step]));
    adjoint->rod += (*by_rod)[RodShape::kRodInput] / kNetworkRod;
    const Vector4<double> seen =
        by_rod->segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * walker.body().mass);
    walker.self.TotalJacobian(p, state, before, &jacobian);
    s.tail<6>() += by_rod->head<6>().cwiseProduct(MotionInputScales());
    s += jacobian.by_state.transpose() * seen;
    sum += jacobian.by_parameter.transpose() * seen;
    by_previous += jacobian.by_previous.cwiseProduct(seen.head<2>());
    by_network += seen;
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
  return by_network;
}

void AdjointGradient::Batch::Backward(const ParameterSet<double>& p,
                                      ParameterSet<double>* by_parameter, double* by_weight) {
  std::vector<Adjoint> adjoints(walkers_.size());  // of the frame after the step
  Eigen::VectorXd by_rod;
  for (int step = columns_.num_steps() - 1; step >= 0; --step) {
    const int people = columns_.active(step);
    rod_velocities_.setZero(people);
    for (int column = 0; column < people; ++column) {
      const Walker& walker = walkers_[column];
      if (!Going(walker, step)) continue;
      (*by_parameter)[kRodLift] += AddResidual(walker, step + 1, p[kRodLift], &adjoints[column]);
      rod_velocities_[column] = walker.scene().dt * adjoints[column].rod;
    }
    if (rod_) rod_->Backward(step, rod_velocities_, &rod_inputs_);

    forces_.setZero(4, people);
    for (int column = 0; column < people; ++column) {
      if (!Going(walkers_[column], step)) continue;
      if (rod_) by_rod = rod_inputs_.col(column);
      forces_.col(column) = StepBack(walkers_[column], p, step, rod_ ? &by_rod : nullptr,
                                     &adjoints[column], by_parameter);
    }
    if (!network_) continue;
    network_->Backward(step, forces_, &inputs_);
    for (int column = 0; column < people; ++column) {
      const auto u = inputs_.col(column);
      adjoints[column].state.tail<6>() += u.head<6>().cwiseProduct(MotionInputScales());
      if (u.size() > kMotionInputs) adjoints[column].rod += u[kMotionInputs] / kNetworkRod;
    }
  }
  if (by_weight == nullptr) return;
  if (network_) network_->AddWeightGradient(by_weight);
  if (rod_) rod_->AddWeightGradient(by_weight + options_.learned->rod_at());
}

}  // namespace pushid
