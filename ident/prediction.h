// ident: what a model says will happen in a scene.
#pragma once

#include <string>
#include <vector>

#include "datasets/pendulum_recording.h"
#include "ident/fit_result.h"
#include "models/rollout.h"

namespace pushid {

struct Prediction {
  RolloutStatus status;
  RolloutPath<double> path;                       // frames before a failure are valid
  ForceTrace forces;                              // what drove it, part by part
  std::vector<std::vector<Vector3<double>>> hip;  // [person][frame], m; empty after a failure
};

// From frame 0 and the push alone. num_frames: 0 means as many as the recording has.
Prediction Predict(const IdentifiedModel& model, const PendulumRecording& recording,
                   int num_frames = 0);

// Writes frame, time and, per person, q, qd, hip and the net force with its parts as CSV;
// after a failure, the frames before it.
MaybeError WriteTrajectoryCsv(const std::string& path, const PendulumRecording& recording,
                              const Prediction& prediction);

}  // namespace pushid
