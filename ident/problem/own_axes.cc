// ident: recordings and rollouts turned into a model's axes, and back.
#include "ident/problem/own_axes.h"

#include <algorithm>
#include <cmath>

#include "models/turn.h"
#include "residuals/rollout_residual.h"

namespace pushid {
namespace {

// The scene with the bodies of a model.
Scene WithBodies(Scene scene, const PendulumRecording& recording, BodyModel body) {
  if (body != BodyModel::kAnthropometric) return scene;
  for (size_t n = 0; n < std::min(scene.people.size(), recording.masses.size()); ++n) {
    scene.people[n].body = Distributed<double>(scene.people[n].body, recording.masses[n]);
  }
  return scene;
}

}  // namespace

double OwnAxes(const PendulumRecording& recording, Directions directions) {
  if (directions == Directions::kAxes) return 0.0;
  // People who touch are deeper than wide.
  const bool touch = recording.scene.num_people() > 1;
  if (directions == Directions::kBody || touch) return recording.facing;
  const Eigen::Vector2d along = PushDirection(recording);
  return std::atan2(along[1], along[0]);
}

std::shared_ptr<const std::vector<PendulumRecording>> InOwnAxes(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options) {
  if (options.directions == Directions::kAxes && options.body != BodyModel::kAnthropometric) {
    return nullptr;
  }
  auto turned = std::make_shared<std::vector<PendulumRecording>>();
  turned->reserve(recordings.size());
  for (const PendulumRecording& recording : recordings) {
    turned->push_back(Turned(recording, OwnAxes(recording, options.directions)));
    turned->back().scene = WithBodies(turned->back().scene, recording, options.body);
  }
  return turned;
}

Scene SceneInOwnAxes(const PendulumRecording& recording, const ModelOptions& options) {
  const double angle = OwnAxes(recording, options.directions);
  return WithBodies(angle == 0.0 ? recording.scene : TurnedScene(recording, angle), recording,
                    options.body);
}

RolloutStatus RolloutInOwnAxes(const PendulumRecording& recording, const ModelOptions& options,
                               const std::vector<ParameterSet<double>>& parameters, int num_frames,
                               RolloutPath<double>* path, FrameTable<NetForce<double>>* trace) {
  const double angle = OwnAxes(recording, options.directions);
  const Scene scene = SceneInOwnAxes(recording, options);
  const RolloutStatus status = Rollout<double>(scene, options, parameters, InitialVelocities(scene),
                                               num_frames, path, trace);
  if (angle == 0.0) return status;
  const TurnedAxes back(-angle);
  for (int t = 0; t < (status.ok ? num_frames : status.frame); ++t) {
    for (int n = 0; n < path->num_people(); ++n) {
      PendulumState<double>& state = path->At(t, n);
      if (trace != nullptr) {
        for (Vector4<double>& part : trace->At(t, n).parts) part = back.Force(state.q, part);
      }
      state.qd = back.PoseJacobian(state.q) * state.qd;
      state.q = back.Pose(state.q);
      state.feet.apart = back.Horizontal(state.feet.apart);
    }
  }
  return status;
}

}  // namespace pushid
