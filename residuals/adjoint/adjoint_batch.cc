// residuals: rollouts side by side. adjoint_batch_backward.cc goes back over them.
#include "residuals/adjoint/adjoint_batch.h"

#include <algorithm>

namespace pushid {
namespace {

int Frames(const AdjointRecording& r) {
  const int frames = r.recording->num_frames();
  return r.horizon > 0 ? std::min(r.horizon, frames) : frames;
}

// In place of the map's values, if any.
std::optional<ParameterSet<double>> Held(const AdjointRecording& r, int person) {
  if (r.held.empty()) return std::nullopt;
  return r.held[r.held.size() == 1 ? 0 : person];
}

PackedColumns ColumnsOf(const std::vector<AdjointRecording>& all,
                        const std::vector<int>& recordings) {
  std::vector<int> steps;
  for (int index : recordings) {
    steps.insert(steps.end(), all[index].recording->num_people(),
                 std::max(0, Frames(all[index]) - 1));
  }
  return PackedColumns(steps);
}

}  // namespace

MeasuredFrame AdjointGradient::Batch::Walker::Measured(int frame, bool rod_moves) const {
  return {recording->hip[person][frame], recording->states[person][frame],
          recording->Weight(person, frame), rod_moves ? recording->RodChange(person, frame) : 0.0};
}

AdjointGradient::Batch::Batch(const std::vector<AdjointRecording>& all,
                              const std::vector<int>& recordings, const ModelOptions& options,
                              const ResidualSigmas& sigmas, const VectorKernels& kernels)
    : options_(options), sigmas_(sigmas), columns_(ColumnsOf(all, recordings)) {
  std::vector<double> masses;
  std::vector<const Scene*> scenes;
  for (int index : recordings) {
    const AdjointRecording& r = all[index];
    const std::vector<SelfForce> self = SelfForces(r.recording->scene, options);
    const int place = static_cast<int>(horizon_.size()), frames = Frames(r);
    horizon_.push_back(frames);
    scenes.push_back(&r.recording->scene);
    for (int n = 0; n < r.recording->num_people(); ++n) {
      walkers_.push_back({r.recording, index, place, n, r.weight, self[n], Held(r, n),
                          std::vector<PendulumState<double>>(frames),
                          std::vector<Vector4<double>>(frames)});
      if (frames > 0) walkers_.back().path[0] = r.recording->scene.people[n].start;
      masses.push_back(self[n].body.mass);
    }
  }
  const LearnedTerms& network = *options_.learned;
  if (network.shape.any()) network_.emplace(network.shape, kernels, columns_, masses);
  if (network.rod.moves()) rod_.emplace(network.rod, kernels, columns_);
  if (options_.interaction.Any()) others_.emplace(options_, scenes, kernels);
  now_.states.resize(walkers_.size());
}

double AdjointGradient::Batch::Forward(const ParameterMap& map, const double* shared,
                                       const double* weights, std::vector<RolloutStatus>* status) {
  end_ = horizon_;
  now_.parameters.clear();
  ParameterMap own = map;
  for (const Walker& walker : walkers_) {
    own.values = walker.held.value_or(map.values);
    now_.parameters.push_back(own.Apply<double>(shared, nullptr));
  }
  if (network_) network_->Start(weights);
  if (rod_) rod_->Start(weights + options_.learned->rod_at());
  if (others_) others_->Start(weights);
  for (int step = 0; step < columns_.num_steps(); ++step) {
    SetStates(step);
    SetForces(step);
    SetReceived(step);
    SetRodVelocities(step);
    Step(step, status);
  }
  return Cost();
}

void AdjointGradient::Batch::SetStates(int step) {
  if (!others_) return;
  for (int column = 0; column < columns_.active(step); ++column) {
    const Walker& walker = walkers_[column];
    if (Going(walker, step)) now_.states[column] = walker.path[step];
  }
}

void AdjointGradient::Batch::SetReceived(int step) {
  if (!others_) return;
  std::vector<bool> going;
  for (int end : end_) going.push_back(step + 1 < end);
  others_->Forward(now_, going, &received_);
}

void AdjointGradient::Batch::SetForces(int step) {
  const int people = columns_.active(step);
  forces_.setZero(4, people);
  if (!network_) return;
  VectorX<double> u(kMotionInputs);
  inputs_.setZero(kMotionInputs, people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    SetMotionInputs<double>(state.q[2] - walker.self.posture[0],
                            state.q[3] - walker.self.posture[1], state.qd, &u);
    inputs_.col(column) = u;
  }
  network_->Forward(step, inputs_, &forces_);
}

void AdjointGradient::Batch::SetRodVelocities(int step) {
  const int people = columns_.active(step);
  rod_velocities_.setZero(people);
  if (!rod_) return;
  RodLayers<double> layers(options_.learned->rod);
  rod_inputs_.setZero(options_.learned->rod.num_inputs(), people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    Vector4<double> force =
        walker.self.Total(Parameters(column), state, walker.VelocityBefore(step));
    force += forces_.col(column);
    force.tail<2>() -= walker.self.hold;
    SetRodInputs<double>(state.q[2] - walker.self.posture[0], state.q[3] - walker.self.posture[1],
                         state.qd, force, state.rod, walker.body(), &layers);
    rod_inputs_.col(column) = layers.inputs;
  }
  rod_->Forward(step, rod_inputs_, &rod_velocities_);
}

void AdjointGradient::Batch::Step(int step, std::vector<RolloutStatus>* status) {
  Vector4<double> received = Vector4<double>::Zero();
  for (int column = 0; column < columns_.active(step); ++column) {
    Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    if (others_) received = received_.col(column);
    const Vector4<double> force =
        NetForceAt<double>(walker.scene(), options_, walker.self, Parameters(column), walker.person,
                           step, state, walker.VelocityBefore(step), received, forces_.col(column))
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

double AdjointGradient::Batch::Cost() const {
  double cost = 0.0;
  for (size_t column = 0; column < walkers_.size(); ++column) {
    const Walker& walker = walkers_[column];
    const double lift = now_.parameters[column][kRodLift];
    for (int t = 1; t < end_[walker.place]; ++t) {
      const PendulumState<double>& state = walker.path[t];
      const FrameVector<double> r =
          walker.weight * FrameResidual<double>(BodyNow(walker.body(), state.rod, lift), state,
                                                walker.Measured(t, rod_.has_value()), sigmas_);
      cost += 0.5 * r.squaredNorm();
    }
  }
  return cost;
}

}  // namespace pushid
