// ident: bodies for people who were never recorded: a formation's people get the skeleton and pose
// of a recorded person, or of the synthetic skeleton, and a restoration moves them, or a generator.
#pragma once

#include <vector>

#include "ident/bodies/body_recording.h"
#include "ident/formations/formation_run.h"
#include "ident/generators/generator_files.h"
#include "models/restoration/postprocess.h"

namespace pushid {

// The synthetic skeleton of this rod length, upright, over a cart at the origin; z = 0 is the
// floor.
Pose SyntheticPose(double rod_length);

// First poses of all people in recordings, in their order.
std::vector<Pose> FirstPoses(const std::vector<BodyRecording>& recordings);

// Puts poses (in turn, should there be fewer than people) where the formation's people stand,
// facing +x, and gives those people the pendulum that goes with the pose: rod length, cart height
// and lean. Masses and pushes stay. Returns the first pose of each person.
std::vector<Pose> TakePoses(const std::vector<Pose>& poses, Scene* scene);

// Restored and post-processed, one motion per person. first_poses: as TakePoses returned them.
std::vector<BodyMotion> FormationBodies(const FormationRun& run,
                                        const std::vector<Pose>& first_poses,
                                        const Restoration& restoration,
                                        const PostprocessOptions& options);

// Whether a generator can take such a scene: people who see each other, at its rate; flag: what
// names its folder. It is shown the first poses from now on, whatever it was made for.
MaybeError PrepareForFormation(const Scene& scene, const std::string& flag,
                               LoadedGenerator* loaded);

// What it makes of the first poses and the pushes, and of where physics have everybody's hip.
Result<std::vector<BodyMotion>> GeneratedBodies(const FormationRun& run,
                                                const std::vector<Pose>& first_poses,
                                                const LoadedGenerator& loaded);

}  // namespace pushid
