// ident: axes of a push, the gains that forecast, and turned axes.
#include "ident/observed/scene_filter.h"

#include <utility>

#include "ident/model/model_rollout.h"
#include "ident/model/push_range.h"
#include "ident/problem/own_axes.h"

namespace pushid {

Eigen::Matrix3d PushAxes(const PendulumRecording& recording) {
  const Eigen::Vector2d along = PushDirection(recording);
  Eigen::Matrix3d axes;
  axes << along.x(), -along.y(), 0.0, along.y(), along.x(), 0.0, 0.0, 0.0, 1.0;
  return axes;
}

SeenHips HipsAt(const PendulumRecording& recording, int frame) {
  SeenHips hips;
  for (int n = 0; n < recording.num_people(); ++n) {
    hips.hip.push_back(recording.hip[n][frame]);
    hips.seen.push_back(recording.Weight(n, frame) > 0.0);
  }
  return hips;
}

namespace {

constexpr double kForceTime = 0.06;  // s, in which the unknown force dies out

// Gains of the reference person (self_terms.h).
void SetForecastGains(ParameterSet<double>* p) {
  for (Parameter id :
       {kMu, kMuY, kCoulombFriction, kKpX, kKpY, kKdX, kKdY, kBx, kBy, kTx, kTy, kCq, kDq}) {
    (*p)[id] = 0.0;
  }
  (*p)[kKpTheta] = (*p)[kKpPhi] = 500.0;
  (*p)[kKdTheta] = (*p)[kKdPhi] = 700.0;
  (*p)[kAx] = (*p)[kAy] = -1.5;
}

}  // namespace

SceneFilter::SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
                         const InputNoise& noise, const PendulumRecording& recording, int frames)
    : angle_(OwnAxes(recording, model.options.directions)),
      to_(angle_),
      back_(-angle_),
      filter_(SceneInOwnAxes(recording, model.options), model.options, std::move(parameters), noise,
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

std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, double tail,
                                          const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (ParameterSet<double>& p : parameters) {
    if (model.options.stance == Stance::kSlide) SetForecastGains(&p);
    ScaleTail(tail, &p);
    p[kTailTime] *= tail;
  }
  InputNoise noise;
  noise.force_time = kForceTime;
  return SceneFilter(model, std::move(parameters), noise, recording, frames);
}

}  // namespace pushid
