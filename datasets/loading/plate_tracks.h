// datasets: force platforms as their files have them: read, turned to the project's axes, added up.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

inline constexpr double kOffPlate = 0.02;  // m beyond the edge, of most frames: a wrong one

// Evenly sampled, in the project's axes: force, and the moments [F_z p_x, F_z p_y, F_z].
struct PlateTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  int last_line = 0;
  int platforms = 0;  // that were added up
  std::vector<Eigen::Vector3d> force, moment;

  void Add(size_t at, const Eigen::Vector3d& on_person, const Eigen::Vector3d& centre) {
    if (force.size() <= at) {
      force.resize(at + 1, Eigen::Vector3d::Zero());
      moment.resize(at + 1, Eigen::Vector3d::Zero());
    }
    force[at] += on_person;
    if (!centre.allFinite() || on_person.z() <= 0.0) return;
    moment[at] += on_person.z() * Eigen::Vector3d(centre.x(), centre.y(), 1.0);
  }
  double last_s() const { return first_s + (static_cast<double>(force.size()) - 1.0) / rate_hz; }
};

// Those of a manifest's entry, of the file that it names or of the motion's; a motion's file has
// the axes of its person. Errors: those of the files, no such platform or column, a centre of
// pressure off the platform.
Result<PlateTracks> ReadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                               const RecordedPerson& person);

// By the kind of file; axes: from the file's to the project's.
Result<PlateTracks> PlatesOfC3d(const std::string& path, const ManifestPlates& plates,
                                const Eigen::Matrix3d& axes);
Result<PlateTracks> PlatesOfTable(const std::string& path, const ManifestPlates& plates,
                                  const Eigen::Matrix3d& axes);

}  // namespace pushid
