// ident: recordings with whole bodies, and what a restoration is told of them.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/bodies/body_skeleton.h"
#include "ident/prediction/prediction.h"
#include "ident/validation/group_metrics.h"
#include "models/restoration/restoration.h"
#include "models/rollout.h"

namespace pushid {

struct BodyRecording {
  PendulumRecording pendulum;
  std::vector<BodyMotion> bodies;        // one per person, by role
  std::vector<std::string> joint_names;  // of the 22 roles, as the first person's file has them
  std::vector<BodySkeleton> skeletons;   // one per person, of the file

  int num_frames() const { return pendulum.num_frames(); }
  int num_people() const { return pendulum.num_people(); }
};

// The recording must have been read with all joints. Errors: roles that no joint of a skeleton
// plays and that its neighbours do not fill (datasets/manifest/body_roles.h).
Result<BodyRecording> MakeBodyRecording(const Recording& recording, SkeletonMapping mapping);
Result<std::vector<BodyRecording>> MakeBodyRecordings(const std::vector<Recording>& recordings,
                                                      SkeletonMapping mapping);
// Of all recordings; of none where not all have such a skeleton, or nobody is in a group.
RecordedBodies BodiesOfGroups(const std::vector<Recording>& recordings);
std::vector<PendulumRecording> PendulumsOf(const std::vector<BodyRecording>& recordings);

// People with predicted pendulums (and whether their feet stand, where a prediction says so, and
// the first poses that it has seen), or with those seen in the recording, after `observed` poses.
std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const Prediction& prediction);
std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const RolloutPath<double>& path);
std::vector<RestorationInput> RecordedPeople(const BodyRecording& recording, int observed = 0);

}  // namespace pushid
