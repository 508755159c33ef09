// datasets: a recording straight from tracks in memory, with the checks of one from files.
//
//   TrackedPerson anna{"anna", 62.0, hip, left_ankle, right_ankle};
//   Result<Recording> recording = RecordingFromTracks({"trial 1", 100.0, {anna}, {push}});
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/loading/warning.h"
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/joint_choice.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// One per frame, m, z up and x forward; NaN where it was not seen.
struct TrackedPerson {
  std::string id;
  double mass_kg = 0.0;
  std::vector<Eigen::Vector3d> hip, left_ankle, right_ankle;
  std::vector<PlateSample> plates{};  // one per frame; empty: nothing measured
};

struct TrackedRecording {
  std::string id;
  double fps = 0.0;
  std::vector<TrackedPerson> people;
  std::vector<Push> pushes;
  int pushed_person = 0;
  PushKind push_kind = PushKind::kExternal;
  InitialVelocity initial_velocity = InitialVelocity::kZero;
  RecordingLabels labels;
  std::vector<GroundPose> ground{};  // one per frame, from rest; empty: it does not move
};

// Gaps are filled as those of files are, and the motion filtered and resampled; what looks unusual
// but can be lived with is appended to `warnings`. Errors: a mass not
// in (0, 400] kg, a rate not in [1, 10000], people with different numbers of frames or fewer than
// three, a first frame that is not seen, what CheckMotion says, pushes on nobody or beyond the
// motion; ground or platforms with other frames than the motion, with numbers that are not finite,
// or together with another rate; ground that moves at frame 0, and platforms that do not measure
// the person's weight.
Result<Recording> RecordingFromTracks(TrackedRecording tracks,
                                      const PreparationOptions& preparation = {},
                                      Warnings* warnings = nullptr);

// The height of a push: a fraction of the way from the ankles to the hip, or metres above the
// ground at its first frame.
struct PushHeight {
  double fraction = 1.0;
  std::optional<double> metres;
};

// Fraction of the rod at which a horizontal plane `height` metres up crosses it.
double HeightFraction(const Body& body, const Vector4<double>& q, double height);

// Forces on a person from frame `start` on, as generalized forces at the recorded poses.
std::vector<Eigen::Vector4d> PushAtHeight(const RecordedPerson& person, int start,
                                          const std::vector<Eigen::Vector3d>& forces,
                                          const PushHeight& height);

}  // namespace pushid
