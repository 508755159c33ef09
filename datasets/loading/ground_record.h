// datasets: how the ground of a recording moved, frame by frame, from a file or from markers on it.
//
//   time,x,y,theta,phi
//   0.00,0.000,0.0,0.0,0.0
//   0.01,0.002,0.0,0.0,0.0
// x, y (x, z of a file whose y is up): m, or m/s, or m/s^2; theta and phi: tilt about y and about x
// as the pendulum's angles are, whatever the file's axes, rad, or per s, or per s^2. Columns that
// lack are zero. Rates are summed up so that they are those by which a rollout steps
// (models/ground.h), from rest. Of markers, the shift is that of the ground under the first person.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/warning.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// A platform moves at frame 0 where it is faster than this, m/s or rad/s, by more than its noise:
// people would not be at rest.
inline constexpr double kGroundAtRest = 0.02;

// Markers of the ground are one body: the distance of two may scatter by this about its mean, m
// (rms); 5 mm of noise of each are 7 mm.
inline constexpr double kRigidMarkers = 0.01;

// Speed of the ground at the first of some poses, in the fastest coordinate, m/s or rad/s: the
// slope of a parabola through them, less what the scatter about it explains (three standard
// errors), and no more than the first step, which is short where ground starts quickly from rest.
double GroundSpeedAtFirst(const std::vector<GroundPose>& poses, double dt);

// How the recording's motion was read: units and rate of the markers in its file, and the low-pass
// of its positions, which the ground gets too (of a CSV only the low-pass counts).
struct GroundReading {
  double metres_per_unit = 1.0;
  double file_fps = 0.0;    // before resampling
  double lowpass_hz = 0.0;  // 0: none
};

// Poses at the recording's frames (its fps, its number of frames), counted from frame 0. Errors:
// those of the files, a column that is misspelt, a record that ends early or begins late, ground
// that does not start at rest, markers that are not there, not seen, on a line or not rigid. A
// warning where gaps of markers were filled.
Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording,
                                           const GroundReading& reading = {},
                                           Warnings* warnings = nullptr);

// Ground that moves as its file has it, in the project's axes.

// Shift and tilt, evenly sampled.
struct GroundTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  std::vector<Eigen::Vector3d> shift, tilt;  // z: nothing
  std::vector<int> lines{};                  // of a file's rows
  double last_s() const { return first_s + (static_cast<double>(shift.size()) - 1.0) / rate_hz; }
};

// The ground of the table that the entry names.
Result<GroundTracks> GroundOfCsv(const ManifestRecording& entry);

// The ground of the markers that the entry names, in the first person's file: the rigid motion of
// what is under that person. Errors and warnings: those of ground_record.h.
Result<GroundTracks> GroundOfMarkers(const ManifestRecording& entry, const Recording& recording,
                                     const GroundReading& reading, Warnings* warnings);

}  // namespace pushid
