// datasets: poses of segments as points.
#include "datasets/formats/c3d_rotations.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "datasets/formats/c3d_parameters.h"

namespace pushid {
namespace {

constexpr char kGroup[] = "ROTATION";
constexpr std::size_t kReal = 4, kRealsOfPose = 17, kPoseColumns = 4;
constexpr int kMostSegments = 32767;
constexpr double kNoRotation = 0.1;  // of a determinant from 1

int Whole(const C3dFile& file, const char* name, int lowest, int highest, int fallback) {
  return C3dWhole(file.parameters, kGroup, name, 0, lowest, highest, fallback);
}

// "pelvis_4X4" -> "pelvis".
std::string SegmentName(const std::string& label) {
  constexpr std::string_view kEnding = "_4X4";
  const bool has = label.size() > kEnding.size() &&
                   label.compare(label.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
  return has ? label.substr(0, label.size() - kEnding.size()) : label;
}

// The origin of the pose that stands at byte `at`; NaN where it was not seen.
Eigen::Vector3d Origin(const C3dBytes& bytes, std::size_t at) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix4d pose;
  for (std::size_t i = 0; i < kPoseColumns * kPoseColumns; ++i) {
    pose(static_cast<int>(i % kPoseColumns), static_cast<int>(i / kPoseColumns)) =
        bytes.Real(at + kReal * i);
  }
  const bool seen = bytes.Real(at + kReal * kPoseColumns * kPoseColumns) >= 0.0 &&
                    pose.allFinite() &&
                    std::abs(pose.topLeftCorner<3, 3>().determinant() - 1.0) < kNoRotation;
  return seen ? Eigen::Vector3d(pose.topRightCorner<3, 1>()) : Eigen::Vector3d(kNaN, kNaN, kNaN);
}

}  // namespace

bool HasC3dRotations(const C3dFile& file) { return Whole(file, "USED", 0, kMostSegments, 0) > 0; }

MaybeError AddC3dRotations(const C3dBytes& bytes, C3dFile* file) {
  const std::size_t segments = Whole(*file, "USED", 0, kMostSegments, 0);
  if (segments == 0) return std::nullopt;
  // A block beyond 32767 stands in a negative integer.
  const double block = C3dNumber(file->parameters, kGroup, "DATA_START", 0, 0.0);
  if (block == 0.0) return C3dError(file->path, 0, "ROTATION:DATA_START is missing");
  const std::size_t begin =
      (static_cast<std::size_t>(block < 0.0 ? block + 65536.0 : block) - 1) * kC3dBlock;
  const std::size_t frame_size =
      kReal * kRealsOfPose * segments * Whole(*file, "RATIO", 1, kMostSegments, 1);
  const std::size_t frames = file->num_frames();
  if (!bytes.Has(begin, frames * frame_size)) {
    return C3dError(file->path, bytes.size(),
                    "the file ends before the last pose of " + std::to_string(frames) +
                        " frames (group ROTATION): it is truncated; export it again");
  }
  std::vector<std::string> names = C3dTexts(file->parameters, kGroup, "LABELS");
  names.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    file->point_names.push_back(names[s].empty() ? "segment_" + std::to_string(s + 1)
                                                 : SegmentName(names[s]));
    std::vector<Eigen::Vector3d> track;
    for (std::size_t t = 0; t < frames; ++t) {
      track.push_back(Origin(bytes, begin + t * frame_size + s * kReal * kRealsOfPose));
    }
    file->points.push_back(std::move(track));
  }
  return std::nullopt;
}

}  // namespace pushid
