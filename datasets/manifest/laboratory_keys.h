// datasets: what a manifest says of a recording's laboratory: ground that moves, force platforms.
//
//   "ground": {"csv": "platform.csv", "quantity": "displacement", "start": 0.5}
//   "ground": {"markers": ["plate1", "plate2", "plate3"]}
//   "force_plates": {"use": "measure", "file": "trial.c3d", "plates": ["platform:1"]}
// The room's README has the tables of their keys.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/json_fields.h"
#include "models/enum_names.h"

namespace pushid {

// What a file of the ground holds.
enum class GroundQuantity { kDisplacement, kVelocity, kAcceleration };
constexpr EnumNames<GroundQuantity, 3> Names(GroundQuantity) {
  return {{{"displacement", GroundQuantity::kDisplacement},
           {"velocity", GroundQuantity::kVelocity},
           {"acceleration", GroundQuantity::kAcceleration}}};
}

struct ManifestGround {
  std::string csv;                   // relative to the manifest; empty: markers
  std::vector<std::string> markers;  // on the ground, in the motion's file
  GroundQuantity quantity = GroundQuantity::kDisplacement;
  std::optional<double> start_s;  // the file's clock at frame 0
  std::string up, forward;        // axes of the file; empty: z and x, of markers the motion's
  bool given() const { return !csv.empty() || !markers.empty(); }
};

// Whether platforms are what a rollout is compared with.
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
  // What columns of moments are about, m, in the file's axes; the surface is at height 0.
  std::optional<Eigen::Vector3d> origin{};
};

// The keys `ground` and `force_plates` of a recording of so many people, where it has them.
ManifestGround ReadGroundKey(const JsonDocument& document, JsonFields* fields);
std::vector<ManifestPlates> ReadPlatesKey(const JsonDocument& document, JsonFields* fields,
                                          int people);

}  // namespace pushid
