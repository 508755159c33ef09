// datasets: the laboratory of a manifest's recording: ground that moves, force platforms.
//
//   "ground": {"csv": "platform.csv", "quantity": "displacement", "start": 0.5}
//   "force_plates": {"use": "measure", "file": "trial.c3d", "plates": ["platform:1"]}
// The room's README has the tables of their keys.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/enum_names.h"

namespace pushid {

class JsonFields;
struct ManifestRecording;

// The quantity in a file of the ground.
enum class GroundQuantity { kDisplacement, kVelocity, kAcceleration };
constexpr EnumNames<GroundQuantity, 3> Names(GroundQuantity) {
  return {{{"displacement", GroundQuantity::kDisplacement},
           {"velocity", GroundQuantity::kVelocity},
           {"acceleration", GroundQuantity::kAcceleration}}};
}

struct ManifestGround {
  std::string csv;  // relative to the manifest; empty: the ground rests
  GroundQuantity quantity = GroundQuantity::kDisplacement;
  std::optional<double> start_s;  // the file's clock at frame 0
  std::string up, forward;        // axes of the file; empty: z and x
  bool given() const { return !csv.empty(); }
};

// Whether rollouts are compared with what platforms measured.
enum class PlateUse { kNone, kMeasure };
constexpr EnumNames<PlateUse, 2> Names(PlateUse) {
  return {{{"none", PlateUse::kNone}, {"measure", PlateUse::kMeasure}}};
}

struct ManifestPlates {
  int person = 0;
  PlateUse use = PlateUse::kNone;
  std::string file;                 // relative to the manifest; empty: the motion's
  std::vector<std::string> plates;  // platform:1 of C3D, prefixes of columns; empty: all there are
  std::optional<double> start_s;    // the file's clock at frame 0
  double lowpass_hz = 0.0;          // 0: 0.4 of the frame rate
  std::string up, forward;          // axes of the file; empty: z and x, of a motion's file its own
  // The point about which columns of moments are, m, in the file's axes; the surface is at height
  // 0.
  std::optional<Eigen::Vector3d> origin{};
};

// The keys `ground` and `force_plates` of a recording of so many people, where it has them.
ManifestGround ReadGroundKey(JsonFields* fields);
std::vector<ManifestPlates> ReadPlatesKey(JsonFields* fields, int people);

// A manifest's entry of a person on force plates whom nothing else measured.
//
//   "motion": "none", "force_plates": {"use": "measure", "file": "quiet.csv"},
//   "subjects": [{"id": "anna", "mass_kg": 62, "rod_m": 0.91}]

// Whether platforms alone measured; then every other key that asks for motion is a mistake.
bool ReadPlatesAlone(JsonFields* fields);

// Checks the keys that such a person needs and may have.
void CheckPlatesAlone(const ManifestRecording& recording, JsonFields* fields);

// Standard deviations of what a fit takes as known, as the laboratory states them.
//
//   "stated_errors": {"push_scale": 0.02, "push_lag_frames": 0.5, "mass": 0.01}

// Errors of measured pushes (kind external): share of the force, frames between its clock and the
// cameras', height (m), zero of the sensor (N); shares of masses and of the frame rate; and how far
// (m) the cameras may drift along the push over a recording. People react late, published ones by
// 0.13 +- 0.04 s: from no delay that is 0.14 s off.
struct StatedErrors {
  double push_scale = 0.05, push_lag_frames = 1.0, push_height_m = 0.05, push_zero_N = 2.0;
  double mass = 0.03, frame_rate = 0.01, drift_m = 0.005;
  double reaction_delay_s = 0.14;
};

struct StatedErrorRow {
  const char* key;
  double StatedErrors::*value;
  bool share = false;  // of the quantity: at most 1
};
inline constexpr StatedErrorRow kStatedErrors[] = {
    {"push_scale", &StatedErrors::push_scale, true},
    {"push_lag_frames", &StatedErrors::push_lag_frames},
    {"push_height_m", &StatedErrors::push_height_m},
    {"push_zero_N", &StatedErrors::push_zero_N},
    {"mass", &StatedErrors::mass, true},
    {"frame_rate", &StatedErrors::frame_rate, true},
    {"drift_m", &StatedErrors::drift_m},
    {"reaction_delay_s", &StatedErrors::reaction_delay_s}};

// The object under "stated_errors", on top of `stated`; Fails at keys that are none of these and at
// values that are not positive.
StatedErrors ReadStatedErrors(JsonFields* fields, StatedErrors stated);

}  // namespace pushid
