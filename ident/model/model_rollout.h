// ident: what all need who roll an identified model out on a recording's scene.
#pragma once

#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "models/scene.h"

namespace pushid {

// One person's hip, frame by frame, m; and everybody's.
using HipPath = std::vector<Vector3<double>>;
using HipPaths = std::vector<HipPath>;

// One set for each person of the recording, moved by what is known of them where the model has
// covariates: those of a mean person where it is not.
std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording);

// Everybody's hips in a rollout; none where it leaves the model's domain.
HipPaths HipsOfRollout(const IdentifiedModel& model, const PendulumRecording& recording,
                       int frames);

// "theta of person 0 leaves the model's domain at frame 31"
std::string OutsideText(const RolloutStatus& status);

}  // namespace pushid
