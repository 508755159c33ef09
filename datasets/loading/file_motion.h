// datasets: the joints or points of one motion file that a person is read from, whatever its
// format.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/joint_choice.h"
#include "datasets/manifest/recording.h"

namespace pushid {

struct FileMotionRequest {
  const std::string& path;
  MotionFormat format;
  // Metres in one of the file's lengths, whatever it says; unset: the file's own unit, else mm.
  std::optional<double> metres_per_unit;
  const JointMapping& joints;
  const ColumnMapping& mapping;
  bool keep_all_joints;  // otherwise hip and feet alone
  int first_frame;       // of those that will be used
  std::function<void(const std::string& warning)> warn;
};

struct FileMotion {
  std::vector<std::vector<Eigen::Vector3d>> tracks;  // of what is read, file's axes, metres
  PendulumJoints places;                             // indices into tracks
  std::vector<std::string> names;
  std::vector<int> parents;   // of BVH joints; otherwise -1 each
  double frame_time_s = 0.0;  // 0: neither file nor mapping says it
  double first_time_s = 0.0;  // by the file's clock
  double metres_per_unit = MetresPer(LengthUnit::kMillimetre);
  // With all joints: who plays which role, and a BVH's hierarchy at the first frame.
  BodyRoles roles;
  std::optional<FileSkeleton> skeleton;
  std::string content_hash;
};

// Errors besides those of the readers: joints that cannot be found, an unknown unit.
Result<FileMotion> ReadFileMotion(const FileMotionRequest& request);

}  // namespace pushid
