// ident: people who are pushed, as particles: 22 joints whose places count from where the hip
// stands above the floor at frame 0, and the push as what acts on them.
//
// Everybody faces the way of the published pushes, +x, or is to be turned there first: a mirror
// changes y. A push of a frame is [Fx, Fy, Ftheta, Fphi] over the mass, in N/kg and N m/kg.
#pragma once

#include <vector>

#include "ident/bodies/body_recording.h"
#include "ident/generators/generator_files.h"

namespace pushid {

inline constexpr int kPushControls = 4;

ParticleLayout PushLayout(const std::vector<std::string>& joint_names);

// One person; pushes of others are not seen.
struct PushedParticles {
  ObservedMotion motion;                             // all frames of the recording
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // m, world
};
PushedParticles ParticlesOf(const BodyRecording& recording, int person);

// Where a prediction has everybody's hip, in the coordinates of their particles.
using GroupHips = std::vector<Eigen::Matrix3Xf>;
GroupHips PendulumHips(const BodyRecording& recording, const Prediction& prediction);

// What physics predict that see as many frames as the generator. Errors: a model that leaves its
// domain.
Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames = 0);

// Everybody of a recording, for generators whose people see each other; hips: or empty.
std::vector<ObservedMotion> GroupOf(const BodyRecording& recording, const GroupHips& hips = {});

// The kinds of a scene's pushes, each once.
std::vector<PushKind> PushKindsOf(const Scene& scene);
// Says which pushes are of a kind that the generator has not learned from; empty: none.
std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene);

// Whether frames of dt seconds are those the generator was trained on.
bool AtRateOf(const GeneratorSettings& settings, double dt);

BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector3d& origin);

// What a generator makes of a recording whose first `observed` frames it is shown: those, then its
// forecast to the recording's end, or for `frames` frames in all. Errors: a recording that is not
// at the generator's rate, or too short.
Result<std::vector<BodyMotion>> GenerateBodies(const GeneratorSettings& settings,
                                               const MotionGenerator& generator,
                                               const BodyRecording& recording,
                                               const GroupHips& hips = {}, int frames = 0);

}  // namespace pushid
