// datasets: a mapping file, JSON: what a program's files mean, said once for all recordings made
// with it.
//
//   {"columns": {"waist": ["wx", "wy", "wz"], "foot_l": ["lx", "ly", "lz"], ...},
//    "joints": {"hip": "waist", "left_ankle": "foot_l", "right_ankle": "foot_r"},
//    "time": "clock", "frame_rate": 100, "length_unit": "cm", "up": "y", "forward": "z"}
//
// Every key is optional. What the manifest says itself wins.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

struct JsonDocument;
class JsonFields;

struct ColumnMapping {
  std::vector<PointColumns> columns;
  JointMapping joints;
  std::string time_column;
  double frame_rate = 0.0;  // frames per second; 0: not said
  std::optional<LengthUnit> length_unit;
  std::optional<double> length_scale;  // m, instead of a unit
  std::string up, forward;             // empty: not said
};

// Errors name line and key; keys that are not known are Errors too, since they would do nothing.
Result<ColumnMapping> ReadColumnMapping(const std::string& path);

// Joints and units, which manifests and mapping files write alike.

// "joints": {"hip": "Hips" or 0 or ["LASI", "RASI"], "left_ankle": ..., "left_knee": ...}: any role
// of recording.h, all optional. "base", a robot's base of support, stands for both ankles.
inline constexpr int kBaseRole = -1;  // its key in JointMapping::others
JointMapping ReadJointMapping(const JsonDocument& document, JsonFields* fields);

// "mm", "cm" or "m"; nullopt when the key is not there.
std::optional<LengthUnit> ReadLengthUnit(JsonFields* fields, const char* key);

// "length_scale", the metres in one of the file's lengths; nullopt when the key is not there.
// Beside "length_unit" it is a mistake.
std::optional<double> ReadLengthScale(JsonFields* fields);

}  // namespace pushid
