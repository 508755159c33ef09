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
// covariates: those of a mean person where it is not. effect: log factor on the tail
// (observed/recording_filter.h).
std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording,
                                                    double effect = 0.0);

// The log factor of a recording on the tail's horizontal force, both of its parts. Its torque
// stays: scaled as well, people left out are predicted worse after first frames (after frame 6:
// 0.094 against 0.086 m).
void ApplyEffect(double effect, ParameterSet<double>* parameters);

// Everybody's hips in rollouts with each of some effects; none where one leaves the model's domain.
std::vector<HipPaths> HipsOfRollouts(const IdentifiedModel& model,
                                     const PendulumRecording& recording,
                                     const std::vector<double>& effects, int frames);

// "theta of person 0 leaves the model's domain at frame 31"
std::string OutsideText(const RolloutStatus& status);

}  // namespace pushid
