// datasets: what force platforms under a person measured, at the frames of the motion.
//
// C3D: platforms of the types of sensors/force_platform.h. Tables: columns that end with fx, fy, fz
// (vx, vy, vz in OpenSim's) and px, py (and pz, which is not needed), for each platform behind a
// prefix of its own:
//   time,fx,fy,fz,px,py             time,left_fx,...,left_py,right_fx,...,right_py
//   time,fx,fy,fz,mx,my,mz          N m about the entry's `origin`, instead of a centre
// N on the person (with moments also on the platform, which can only be pressed), m, in the axes
// that are said. Forces of several platforms add up, and their
// moments do. Low-passed without delay below half the frame rate before frames are taken.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

inline constexpr double kWeightTolerance = 0.05;  // of the mean vertical force about m g
inline constexpr double kFarFromFeet = 0.6;       // m, of the centre of pressure

// Checks that whoever stands on the platforms of `file` weighs what these measure, and stands
// nearest to where they are pressed.
MaybeError CheckPlates(const std::string& file, const Recording& recording, int person);

// Into the person's `plates`. Errors: those of the files, no such platform or column, a record that
// ends early, a mean vertical force that is not the weight, a centre of pressure off the platform
// or far from the feet.
MaybeError LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                      double lowpass_hz, Recording* recording);

// Force platforms as their files have them: read, turned to the project's axes, added up.

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

// The platforms of a manifest's entry, from the file that it names or from the motion's; a motion's
// file has the axes of its person. Errors: those of the files, no such platform or column, a centre
// of pressure off the platform.
Result<PlateTracks> ReadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                               const RecordedPerson& person);

// Readers by the kind of file; axes: from the file's to the project's.
Result<PlateTracks> PlatesOfC3d(const std::string& path, const ManifestPlates& plates,
                                const Eigen::Matrix3d& axes);
Result<PlateTracks> PlatesOfTable(const std::string& path, const ManifestPlates& plates,
                                  const Eigen::Matrix3d& axes);

}  // namespace pushid
