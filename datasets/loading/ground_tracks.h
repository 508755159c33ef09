// datasets: ground that moves as its file has it, in the project's axes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/ground_record.h"
#include "datasets/loading/warning.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// Shift and tilt, evenly sampled.
struct GroundTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  std::vector<Eigen::Vector3d> shift, tilt;  // z: nothing
  std::vector<int> lines{};                  // of a file's rows
  double last_s() const { return first_s + (static_cast<double>(shift.size()) - 1.0) / rate_hz; }
};

// From the table that the entry names.
Result<GroundTracks> GroundOfCsv(const ManifestRecording& entry);

// From the markers that the entry names, in the first person's file: the rigid motion of what is
// under that person. Errors and warnings: those of ground_record.h.
Result<GroundTracks> GroundOfMarkers(const ManifestRecording& entry, const Recording& recording,
                                     const GroundReading& reading, Warnings* warnings);

}  // namespace pushid
