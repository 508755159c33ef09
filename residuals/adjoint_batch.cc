// residuals: rollouts side by side, forwards and backwards.
#include "residuals/adjoint_batch.h"

#include <algorithm>

namespace pushid {
namespace {

// Of what the network sees: [theta, phi, xd, yd, thd, phd].
const Eigen::Matrix<double, 6, 1>& InputScales() {
  static const Eigen::Matrix<double, 6, 1> scales =
      (Eigen::Matrix<double, 6, 1>() << kNetworkAngle, kNetworkAngle, kNetworkSpeed, kNetworkSpeed,
       kNetworkRate, kNetworkRate)
          .finished();
  return scales;
}

int Frames(const AdjointRecording& r) {
  const int frames = r.recording->num_frames();
  return r.horizon > 0 ? std::min(r.horizon, frames) : frames;
}

NetworkLockstep MakeNetwork(const std::vector<AdjointRecording>& all,
                            const std::vector<int>& recordings, const ModelOptions& options,
                            const VectorKernels& kernels) {
  std::vector<double> masses;
  std::vector<int> steps;
  for (int index : recordings) {
    for (const ScenePerson& person : all[index].recording->scene.people) {
      masses.push_back(person.body.mass);
      steps.push_back(std::max(0, Frames(all[index]) - 1));
    }
  }
  return {options.self_network->shape, kernels, masses, steps};
}

}  // namespace

MeasuredFrame AdjointGradient::Batch::Walker::Measured(int frame) const {
  return {recording->hip[person][frame], recording->states[person][frame],
          recording->Weight(person, frame)};
}

AdjointGradient::Batch::Batch(const std::vector<AdjointRecording>& all,
                              const std::vector<int>& recordings, const ModelOptions& options,
                              const ResidualSigmas& sigmas, const VectorKernels& kernels)
    : options_(options), sigmas_(sigmas), network_(MakeNetwork(all, recordings, options, kernels)) {
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
    }
  }
}

double AdjointGradient::Batch::Forward(const ParameterSet<double>& p, const double* weights,
                                       std::vector<RolloutStatus>* status) {
  end_ = horizon_;
  network_.Start(weights);
  for (int step = 0; step < network_.num_steps(); ++step) {
    SetInputs(step);
    network_.Forward(step, inputs_, &forces_);
    Step(p, step, status);
  }
  return Cost();
}

void AdjointGradient::Batch::SetInputs(int step) {
  const NetworkShape& shape = options_.self_network->shape;
  inputs_.setZero(shape.num_inputs(), network_.active(step));  // the rod does not move here
  for (int column = 0; column < inputs_.cols(); ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    auto u = inputs_.col(column);
    u.head<2>() = (state.q.tail<2>() - walker.self.posture) / kNetworkAngle;
    u.segment<2>(2) = state.qd.head<2>() / kNetworkSpeed;
    u.segment<2>(4) = state.qd.tail<2>() / kNetworkRate;
  }
}

void AdjointGradient::Batch::Step(const ParameterSet<double>& p, int step,
                                  std::vector<RolloutStatus>* status) {
  for (int column = 0; column < inputs_.cols(); ++column) {
    Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    const Vector4<double> force =
        NetForceAt<double>(walker.scene(), options_, walker.self, p, walker.person, step, state,
                           walker.VelocityBefore(step), {}, forces_.col(column))
            .Total();
    walker.acceleration[step] = Acceleration(walker.body(), state, force);
    walker.path[step + 1] = pushid::Step(state, walker.acceleration[step], walker.scene().dt);
    const std::string_view outside = OutsideDomain(walker.body(), walker.path[step + 1]);
    if (outside.empty()) continue;
    (*status)[walker.index] = {false, step + 1, walker.person, outside};
    end_[walker.place] = step + 1;
    for (int other = 0; other < inputs_.cols(); ++other) {
      if (walkers_[other].place == walker.place) network_.Forget(step, other);
    }
  }
}

double AdjointGradient::Batch::Cost() const {
  double cost = 0.0;
  for (const Walker& walker : walkers_) {
    for (int t = 1; t < end_[walker.place]; ++t) {
      const FrameVector<double> r =
          walker.weight *
          FrameResidual<double>(walker.body(), walker.path[t], walker.Measured(t), sigmas_);
      cost += 0.5 * r.squaredNorm();
    }
  }
  return cost;
}

void AdjointGradient::Batch::AddResidual(const Walker& walker, int frame, State* adjoint) const {
  Eigen::Matrix<double, kFrameResiduals, 8> by_state;
  const FrameVector<double> r = FrameResidualWithJacobian(
      walker.body(), walker.path[frame], walker.Measured(frame), sigmas_, &by_state);
  *adjoint += walker.weight * walker.weight * (by_state.transpose() * r);
}

void AdjointGradient::Batch::Backward(const ParameterSet<double>& p,
                                      ParameterSet<double>* by_parameter, double* by_weight) {
  std::vector<State> adjoints(walkers_.size(), State::Zero());  // of the frame after the step
  // What the backward difference of the cart's velocity hands to the frame before.
  std::vector<Eigen::Vector2d> owed(walkers_.size(), Eigen::Vector2d::Zero());
  Eigen::Map<Eigen::Matrix<double, kNumParameters, 1>> sum(by_parameter->data());
  SelfForce::Jacobian jacobian;
  for (int step = network_.num_steps() - 1; step >= 0; --step) {
    forces_.setZero(4, network_.active(step));
    for (int column = 0; column < forces_.cols(); ++column) {
      const Walker& walker = walkers_[column];
      if (!Going(walker, step)) continue;
      State& adjoint = adjoints[column];
      AddResidual(walker, step + 1, &adjoint);

      const double dt = walker.scene().dt;
      const PendulumState<double>& state = walker.path[step];
      const Vector4<double> g = adjoint.tail<4>() + dt * adjoint.head<4>();
      const Vector4<double> f = dt * (InverseMassMatrix(walker.body(), state.q) * g);
      NetForceJacobian(walker.scene(), options_, walker.self, p, walker.person, step, state,
                       walker.VelocityBefore(step), &jacobian);
      const Matrix4<double> rigid =
          InverseDynamicsJacobian(walker.body(), state, walker.acceleration[step]);
      jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
      jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
      adjoint.tail<4>() = g;
      adjoint += jacobian.by_state.transpose() * f;
      adjoint.segment<2>(4) += owed[column];
      owed[column].setZero();
      if (walker.self.cart_derivative) {
        const Eigen::Vector2d before = jacobian.by_previous.cwiseProduct(f.head<2>());
        if (step > 0) {
          owed[column] = before;
        } else {
          adjoint.segment<2>(4) += before;
        }
      }
      sum += jacobian.by_parameter.transpose() * f;
      if (ForcesAt(walker.scene(), options_.push, walker.person, step) == ActiveForces::kAll) {
        forces_.col(column) = f;
      }
    }
    network_.Backward(step, forces_, &inputs_);
    for (int column = 0; column < inputs_.cols(); ++column) {
      adjoints[column].tail<6>() += inputs_.col(column).head<6>().cwiseQuotient(InputScales());
    }
  }
  if (by_weight != nullptr) network_.AddWeightGradient(by_weight);
}

}  // namespace pushid
