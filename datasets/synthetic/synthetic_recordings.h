// datasets: recordings made by the model itself, with known parameters, for recovery and coverage
// studies, for tests, and as an example of the file formats.
//
//   SyntheticOptions options;
//   options.joint_noise_m = 0.002;
//   Result<std::vector<SyntheticRecording>> made = MakeSyntheticRecordings(options);
//   // writes out/manifest.json
//   MaybeError failed = WriteSyntheticRecordings("out", options, made.value());
//
// Every recording is one person, or a row of them one behind the other, who stand; the last in the
// row (the first along +x) is pushed mostly forwards and partly to the side; all move as Rollout
// says, driven by process noise where the model has any. The same options and seed give the same
// bytes everywhere. Noise of both kinds, gain variation and motion draw from separate streams:
// changing one leaves the others as they were.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "datasets/manifest/recording.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/scene.h"

namespace pushid {

// A rigid human skeleton of 22 joints whose pendulum is known exactly.
//
// Legs, pelvis and the line between the ankles form a parallelogram: the hip joints are carried at
// +-w to the side of the root, the ankles at +-w to the side of the cart, trunk and feet stay
// level. Both legs are then parallel to the rod and as long, whatever the lean, so that
//   - the ankles' midpoint is the cart at constant height, the root is HipPosition,
//   - every bone keeps its length, and the knees their small constant bend.
// Rejected: feet fixed under a pelvis that tilts with the rod. The legs would have to change their
// length, or the ankles their height, and the mapped pendulum would not be the one rolled out.
//
// The root and both ankles have position channels, so that noise reaches hip and ankles
// independently; without noise the ankles' channels equal their offsets.

// Joint indices in the skeleton of the published recordings of those the pendulum is read from.
inline constexpr int kHipJoint = 0, kRightAnkleJoint = 16, kLeftAnkleJoint = 20;
inline constexpr int kSkeletonJoints = 22;

// Positions that one frame is posed from, metres, and the rod's angles, radians.
struct SkeletonPose {
  double theta = 0.0, phi = 0.0;
  Eigen::Vector3d hip, left_ankle, right_ankle;
};

class SyntheticSkeleton {
 public:
  // Standing upright, the hip is rod_length (m) above the midpoint of the ankles.
  explicit SyntheticSkeleton(double rod_length);

  double rod_length() const { return rod_; }
  double cart_height() const;              // of the ankles above the ground, m
  Eigen::Vector3d HalfStance() const;      // from the cart to the left ankle, m
  BvhSkeleton Bvh(LengthUnit unit) const;  // offsets, names, channels

  // The channel values of one frame, in file order, lengths in `unit`, appended to `values`.
  void AppendFrame(const SkeletonPose& pose, LengthUnit unit, std::vector<double>* values) const;

 private:
  double rod_;   // m
  double bone_;  // thigh and shank, m
  double bend_;  // of thigh forward and shank backward against the rod, rad
};

// A push's strength: its label, and its peak force over the body's mass.
struct PushStrength {
  std::string name;
  double acceleration;  // m/s^2
};

// The settled tail model for the person of 85 kg and 0.95 m: round values near those identified
// from the published recordings of single people.
ParameterSet<double> PublishedTailParameters();
// Values for people who touch, near those identified from the published groups.
ParameterSet<double> PublishedGroupParameters();
// Values for feet that hold and step (models/stance.h).
ParameterSet<double> PublishedStanceParameters();

struct SyntheticOptions {
  // The truth. model.push decides what a `net` push is: with kAdded, a force beside all others;
  // with kAsRecorded, the whole generalized force on the person while it lasts.
  ModelOptions model;
  ParameterSet<double> parameters = PublishedTailParameters();

  int subjects = 4;
  int recordings_per_subject = 6;  // with this subject pushed; the strengths in turn
  // People in a row in every recording: the pushed subject and the ones after it. More than one
  // make sense with model.interaction.
  int people_in_row = 1;
  std::vector<PushStrength> strengths = {{"weak", 2.0}, {"medium", 3.0}, {"strong", 4.0}};
  double fps = 60.0;
  int frames = 90;  // per recording
  uint64_t seed = 1;

  // People, drawn evenly from these ranges.
  double min_mass_kg = 55.0, max_mass_kg = 115.0;
  double min_rod_m = 0.82, max_rod_m = 1.02;
  double lean_sigma_rad = 0.02;  // of both angles at frame 0, about upright

  // Ground that moves: a pose for each frame of every recording; in memory alone.
  std::vector<GroundPose> ground = {};

  bool pushes = true;  // false: nobody is pushed
  // Pushes. `net`: the rising quarter of a sine, which the model's tail completes. `external`: a
  // half-sine. Zero durations: 0.05-0.15 s for net ones, 0.15-0.35 s for external ones.
  PushKind push_kind = PushKind::kNet;
  double min_push_s = 0.0, max_push_s = 0.0;
  int push_start_frame = 0;
  double direction_sigma_rad = 0.25;           // of the direction to both sides of forward
  double min_height = 0.80, max_height = 1.0;  // of the contact, fraction of the rod

  // Spread of all non-zero parameters about the truth: every one is multiplied by exp(spread N),
  // drawn once per recording or once per subject.
  double recording_spread = 0.0;
  double subject_spread = 0.0;

  // Normal noise on every coordinate of hip and ankles, m (1 sigma).
  double joint_noise_m = 0.0;
  // Frame 0 sets rod length, start and posture of a fit; false keeps it exact, for studies that
  // must not mix errors in the motion with errors in these.
  bool noise_at_first_frame = true;
  // Where it is not zero, the noise is drawn from this seed, so that one set of motions can have
  // several draws of noise.
  uint64_t noise_seed = 0;
};

struct SyntheticRecording {
  Recording recording;                           // with noise
  std::vector<ParameterSet<double>> parameters;  // the truth of each person in this very recording
  Scene scene;                                   // what was rolled out
  RolloutPath<double> path;                      // the motion without noise
  std::vector<SyntheticSkeleton> skeletons;      // one per person
};

// Fails when a person falls (names recording, frame and quantity).
Result<std::vector<SyntheticRecording>> MakeSyntheticRecordings(const SyntheticOptions& options);

// The recordings alone.
std::vector<Recording> Recordings(const std::vector<SyntheticRecording>& synthetic);

// Writes folder/manifest.json, folder/bvh/<id>.bvh (mm; <id>_<n>.bvh for person n of a row) and
// folder/push/<id>.csv, making the folders; ground is not written. The manifest's
// key `synthetic` holds seed, noise and the true parameters by name.
MaybeError WriteSyntheticRecordings(const std::string& folder, const SyntheticOptions& options,
                                    const std::vector<SyntheticRecording>& recordings);

}  // namespace pushid
