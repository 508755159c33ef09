// ident: how a model sees a recording: in its axes (Directions: turned about the vertical, along
// the push on a person alone, or along what the people face), and with the masses where it has them
// (BodyModel).
#pragma once

#include <memory>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/net_force.h"
#include "models/options.h"

namespace pushid {

// rad, from the file's x axis to the model's.
double OwnAxes(const PendulumRecording& recording, Directions directions);

// The recordings as a model sees them; null where that is as the files have them.
std::shared_ptr<const std::vector<PendulumRecording>> InOwnAxes(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options);

// The scene of one of them.
Scene SceneInOwnAxes(const PendulumRecording& recording, const ModelOptions& options);

// A rollout in a model's axes, seen in those of the file: what a fit that sees recordings in the
// model's axes predicts. path and trace as those of Rollout.
RolloutStatus RolloutInOwnAxes(const PendulumRecording& recording, const ModelOptions& options,
                               const std::vector<ParameterSet<double>>& parameters, int num_frames,
                               RolloutPath<double>* path,
                               FrameTable<NetForce<double>>* trace = nullptr);

}  // namespace pushid
