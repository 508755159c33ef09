// ident: a filter turned into the model's axes and back.
#include "ident/observed/scene_filter.h"

#include <utility>

#include "ident/problem/own_axes.h"

namespace pushid {
namespace {

// Of the reference person (self_terms.h).
void SetForecastGains(ParameterSet<double>* p) {
  for (Parameter id :
       {kMu, kMuY, kCoulombFriction, kKpX, kKpY, kKdX, kKdY, kBx, kBy, kTx, kTy, kCq, kDq}) {
    (*p)[id] = 0.0;
  }
  (*p)[kKpTheta] = (*p)[kKpPhi] = 500.0;
  (*p)[kKdTheta] = (*p)[kKdPhi] = 700.0;
  (*p)[kAx] = (*p)[kAy] = -1.5;
}

Scene SceneOf(const IdentifiedModel& model, const PendulumRecording& recording, double angle) {
  const Scene scene = angle == 0.0 ? recording.scene : TurnedScene(recording, angle);
  return WithBodies(scene, recording, model.options.body);
}

}  // namespace

SceneFilter::SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
                         const InputNoise& noise, const PendulumRecording& recording, int frames)
    : angle_(OwnAxes(recording, model.options.directions)),
      to_(angle_),
      back_(-angle_),
      filter_(SceneOf(model, recording, angle_), model.options, std::move(parameters), noise,
              frames) {}

RolloutStatus SceneFilter::Observe(const std::vector<PendulumState<double>>& measured,
                                   const std::vector<bool>& seen) {
  if (angle_ == 0.0) return filter_.Observe(measured, seen);
  std::vector<PendulumState<double>> turned = measured;
  for (PendulumState<double>& state : turned) state.q = to_.Pose(state.q);
  return filter_.Observe(turned, seen);
}

PendulumState<double> SceneFilter::TurnedBack(PendulumState<double> state) const {
  if (angle_ == 0.0) return state;
  state.qd = back_.PoseJacobian(state.q) * state.qd;
  state.q = back_.Pose(state.q);
  return state;
}

RolloutStatus SceneFilter::Forecast(RolloutPath<double>* path) const {
  const RolloutStatus status = filter_.Forecast(path);
  if (angle_ == 0.0 || !status.ok) return status;
  for (int t = 0; t < path->num_frames(); ++t) {
    for (int n = 0; n < path->num_people(); ++n) path->At(t, n) = TurnedBack(path->At(t, n));
  }
  return status;
}

Vector4<double> SceneFilter::Force(int person) const {
  return back_.Force(filter_.state(person).q, filter_.Input(person));
}

Vector4<double> SceneFilter::ForceDeviation(int person) const {
  // The planes are independent; people lean little, so that torques turn as forces do.
  const Vector4<double> own = filter_.InputDeviation(person);
  const Eigen::Vector2d x = back_.Horizontal({1.0, 0.0}).cwiseAbs2();
  const Eigen::Vector2d y = back_.Horizontal({0.0, 1.0}).cwiseAbs2();
  Vector4<double> turned;
  for (int i : {0, 2}) {
    turned.segment<2>(i) = (x * own[i] * own[i] + y * own[i + 1] * own[i + 1]).cwiseSqrt();
  }
  return turned;
}

std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, const ForecastStack& stack,
                                          const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (ParameterSet<double>& p : parameters) {
    if (model.options.stance == Stance::kSlide) SetForecastGains(&p);
    ScaleTail(stack.tail_strength, &p);
    p[kTailTime] *= stack.tail_time;
  }
  return SceneFilter(model, std::move(parameters), stack.noise, recording, frames);
}

std::optional<SceneFilter> UnknownForceFilter(const IdentifiedModel& model, const InputNoise& noise,
                                              const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  return SceneFilter(model, PeoplesParameters(model, recording), noise, recording, frames);
}

}  // namespace pushid
