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
#include "datasets/manifest/manifest.h"

namespace pushid {

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

}  // namespace pushid
