// ident: rollouts of an identified model on a recording's scene, and how far they extrapolate.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"

namespace pushid {

// One person's hip, frame by frame, m; and everybody's.
using HipPath = std::vector<Vector3<double>>;
using HipPaths = std::vector<HipPath>;

// One set for each person of the recording, moved by what is known of them where the model has
// covariates: those of a mean person where it is not.
std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording);

// "theta of person 0 leaves the model's domain at frame 31"
std::string OutsideText(const RolloutStatus& status);

// The pushes and people that a model was fitted to, and predictions beyond them.
//
// The effect of a push is its impulse over the person's mass: of its rows and of the tail
// that the model gives it, so that a measured push and the part of one compare. How long it lasts
// compares among pushes of one kind only: the rows of a net push cover its beginning.

// The speed that the recorded rows alone give people, m/s; tails not counted.
double PushSpeed(const PendulumRecording& recording);
PushRange FittedPushRange(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings);

// Farther outside the range than this, a prediction is an extrapolation.
inline constexpr double kBeyondFittedRange = 1.25;
inline constexpr double kBeyondFittedAngle = 45.0;  // degrees

// Warnings, one sentence each on the durations, impulses, heights and directions of pushes,
// and on masses and spacings of people, that lie outside; none where the model has no range.
std::vector<std::string> ExtrapolationWarnings(const IdentifiedModel& model,
                                               const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
