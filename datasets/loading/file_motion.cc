// datasets: skeletons and points read alike.
#include <algorithm>
#include <numeric>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/loading/recording_from_tracks.h"
#include "datasets/manifest/joint_choice.h"
#include "models/enum_names.h"

namespace pushid {
namespace {

// Turns indices into the file's joints to indices into the list of those that are read.
std::vector<int> Among(const std::vector<int>& wanted, std::vector<int>* read) {
  std::vector<int> places;
  for (int joint : wanted) {
    const auto found = std::find(read->begin(), read->end(), joint);
    places.push_back(static_cast<int>(found - read->begin()));
    if (found == read->end()) read->push_back(joint);
  }
  return places;
}

// Which of the file's `all` joints are read; where the pendulum's stand among those.
std::vector<int> Wanted(const FileMotionRequest& request, const PendulumJoints& joints,
                        std::size_t all, FileMotion* motion) {
  std::vector<int> read(request.keep_all_joints ? all : 0);
  std::iota(read.begin(), read.end(), 0);
  for (const PendulumTrack& row : kPendulumTracks) {
    motion->places.*row.joints = Among(joints.*row.joints, &read);
  }
  return read;
}

// Of the file's joints, which are all kept where there are roles.
MaybeError SetRoles(const FileMotionRequest& request, const std::vector<std::string>& names,
                    const BvhSkeleton* skeleton, const PendulumJoints& joints, FileMotion* motion) {
  if (!request.keep_all_joints) return std::nullopt;
  Result<BodyRoles> roles = ChooseRoles(request.path, names, skeleton, joints, request.joints);
  if (!roles.ok()) return roles.error();
  motion->roles = std::move(roles.value());
  return std::nullopt;
}

Result<FileMotion> ReadSkeleton(const FileMotionRequest& request) {
  FileMotion motion;
  motion.metres_per_unit = request.metres_per_unit.value_or(motion.metres_per_unit);
  BvhPositionOptions options;
  options.metres_per_unit = motion.metres_per_unit;
  if (request.keep_all_joints) options.kept_frame = request.first_frame;
  options.choose_joints = [&](const BvhSkeleton& skeleton) -> Result<std::vector<int>> {
    const Result<PendulumJoints> joints =
        ChoosePendulumJoints(request.path, skeleton, request.joints);
    if (!joints.ok()) return joints.error();
    if (MaybeError failed =
            SetRoles(request, skeleton.Names(), &skeleton, joints.value(), &motion)) {
      return *std::move(failed);
    }
    return Wanted(request, joints.value(), skeleton.joints.size(), &motion);
  };
  Result<BvhPositions> bvh = ReadBvhPositions(request.path, options);
  if (!bvh.ok()) return bvh.error();
  motion.tracks = std::move(bvh.value().positions);
  motion.frame_time_s = bvh.value().frame_time_s;
  motion.content_hash = bvh.value().content_hash;
  for (int joint : bvh.value().joints) {
    motion.names.push_back(bvh.value().skeleton.joints[joint].name);
    motion.parents.push_back(bvh.value().skeleton.joints[joint].parent);
  }
  if (request.keep_all_joints) {
    motion.skeleton = FileSkeleton{std::move(bvh.value().skeleton),
                                   std::move(bvh.value().kept_values), motion.metres_per_unit};
  }
  return motion;
}

// An Error where a file gives a unit that is not known and nothing else says one.
MaybeError SetUnit(const FileMotionRequest& request, const PointMotion& points,
                   FileMotion* motion) {
  const double files = points.unit ? MetresPer(*points.unit) : motion->metres_per_unit;
  motion->metres_per_unit = request.metres_per_unit.value_or(files);
  if (!points.unit && !Trimmed(points.unit_text).empty() && !request.metres_per_unit) {
    return Error{"gives lengths in " + Quoted(points.unit_text) +
                     ", an unknown unit; give length_unit (" + AnyName<LengthUnit>() +
                     ") or length_scale (m) in the manifest",
                 request.path};
  }
  if (points.unit && files != motion->metres_per_unit) {
    request.warn("gives lengths in " + NameOf(*points.unit) + "; they are read as " +
                 LengthText(motion->metres_per_unit));
  }
  return std::nullopt;
}

Result<FileMotion> ReadPoints(const FileMotionRequest& request) {
  FileMotion motion;
  PointReadOptions options;
  options.columns = request.mapping.columns;
  options.time_column = request.mapping.time_column;
  options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    const Result<PendulumJoints> joints = ChoosePendulumPoints(request.path, names, request.joints);
    if (!joints.ok()) return joints.error();
    if (MaybeError failed = SetRoles(request, names, nullptr, joints.value(), &motion)) {
      return *std::move(failed);
    }
    return Wanted(request, joints.value(), names.size(), &motion);
  };
  Result<PointMotion> read = ReadPointMotion(request.path, request.format, options);
  if (!read.ok()) return read.error();
  PointMotion& points = read.value();
  if (MaybeError failed = SetUnit(request, points, &motion)) return *std::move(failed);
  motion.tracks = std::move(points.positions);
  for (auto& track : motion.tracks) {
    for (Eigen::Vector3d& position : track) position *= motion.metres_per_unit;
  }
  const double rate =
      request.mapping.frame_rate > 0.0 ? request.mapping.frame_rate : points.rate_hz;
  motion.frame_time_s = rate > 0.0 ? 1.0 / rate : 0.0;
  motion.first_time_s = points.first_time_s;
  motion.content_hash = points.content_hash;
  for (int point : points.chosen) motion.names.push_back(points.names[point]);
  motion.parents.assign(motion.names.size(), -1);
  return motion;
}

}  // namespace

Result<FileMotion> ReadFileMotion(const FileMotionRequest& request) {
  return HasSkeleton(request.format) ? ReadSkeleton(request) : ReadPoints(request);
}

}  // namespace pushid
