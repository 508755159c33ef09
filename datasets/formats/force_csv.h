// datasets: forces as CSV files: a push as its generalized force, and the record of a force sensor.
//
// A push:
//
//   frame,fx,fy,ftheta,fphi
//   0,145.18,-115.38,101.0,121.19
//   1,136.54,-21.54,92.83,27.64
//
// Row t is the generalized force [fx N, fy N, ftheta N m, fphi N m], in the project's axes (x
// forward, y left, z up), that drives the step from the push's frame t to t + 1. Rows count 0, 1,
// 2, ... without gaps. ftheta and fphi are the force's torques about the ankles; 0 is a push at the
// ankles. A file without these two columns has the forces of a push at a height that the manifest
// gives (push_height_m), or at the hip.
//
// Names in any case, in quotes, with their unit ("Force (N)"), separated by commas, semicolons or
// tabs, are the same names.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct PushRows {
  std::vector<Eigen::Vector4d> force;
  bool has_torques = true;  // otherwise the last two are 0
};

// Whether a table's columns are those of a push, or of a sensor's record.
bool IsPush(const std::vector<std::string>& names);
bool IsSensor(const std::vector<std::string>& names);

// Errors name the line: wrong header, a row number out of sequence, too few or many fields, a field
// that is not a finite number, no rows at all.
Result<PushRows> ReadPushCsv(const std::string& path);

// Writes atomically; numbers are the shortest that read back to the same double.
MaybeError WritePushCsv(const std::string& path, const std::vector<Eigen::Vector4d>& force);

// The record of a force sensor, in one of two forms:
//
//   time,force                 time,fx,fy,fz
//   0.000,0.0                  0.000,0.0,0.0,0.0
//   0.001,1.7                  0.001,1.7,-0.2,0.0
//
// time in s (or ms, numeric_table.h) on the sensor's clock, ascending, evenly spaced or nearly so;
// force in N along the sensor's axis, or as a vector in the project's axes (x forward, y left, z
// up).
struct SensorRecord {
  std::vector<double> time_s;
  std::vector<Eigen::Vector3d> force;  // N; a force along an axis stands in x
  bool is_vector = false;              // whether the file had fx, fy, fz
  std::string file;                    // for messages
  // Height of the push above the file's zero, m, where the sensor knows it (a platform on a wall).
  std::optional<double> height_m;
  Eigen::Vector3d subtracted = Eigen::Vector3d::Zero();  // N, what it read at rest
  double noise = 0.0;                                    // N, one standard deviation at rest

  int num_samples() const { return static_cast<int>(time_s.size()); }
};

// A pause between samples longer than this many usual ones is a gap: what the force did there is
// unknown, and bridging it would invent an impulse.
inline constexpr double kMaxSensorPause = 5.0;

// Errors name file and line: another header, too few or many values, empty fields, NaN and other
// text, times that do not ascend, gaps, fewer than three samples.
Result<SensorRecord> ReadSensorCsv(const std::string& path);

// A sentence where a sensor's range was exceeded: it stays exactly at its largest value, and only
// there; otherwise nothing.
std::string ClippedText(const SensorRecord& record);

}  // namespace pushid
