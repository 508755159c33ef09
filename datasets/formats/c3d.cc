// datasets: C3D files as data: points, events, force platforms, poses of segments.
#include "datasets/formats/c3d.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/c3d_parameters.h"

namespace pushid {
namespace {

constexpr int kShortLabels = 12345;  // header word 150: event labels have four letters
constexpr int kHeaderEvents = 18;
constexpr int kMostPlatforms = 255;
constexpr char kPlatforms[] = "FORCE_PLATFORM";

Error PlatformError(const C3dFile& file, int index, const std::string& problem) {
  return {"force platform " + std::to_string(index + 1) + " " + problem, file.path};
}

Result<C3dPlatform> ReadPlatform(const C3dFile& file, int index, int stride) {
  const auto number = [&file](const char* name, int at, double fallback) {
    return file.parameters.Number(kPlatforms, name, at, fallback);
  };
  C3dPlatform platform;
  platform.type = file.parameters.Whole(kPlatforms, "TYPE", index, -1000, 1000, 0);
  if (platform.type < 1 || platform.type > 4) {
    return PlatformError(
        file, index, "has the type " + std::to_string(platform.type) + "; types 1 to 4 are known");
  }
  const int needed = platform.type == 3 ? 8 : 6;
  if (stride < needed) {
    return PlatformError(file, index, "has fewer than " + std::to_string(needed) + " channels");
  }
  const int channels = static_cast<int>(file.analog.size());
  for (int c = 0; c < needed; ++c) {
    const double channel = number("CHANNEL", index * stride + c, 0.0);
    if (!(channel >= 1.0 && channel <= channels)) {
      return PlatformError(
          file, index,
          "names channel " + Rounded(channel) + "; there are 1 to " + std::to_string(channels));
    }
    platform.channels.push_back(static_cast<int>(channel) - 1);
  }
  for (int k = 0; k < 12; ++k) {
    platform.corners(k % 3, k / 3) = number("CORNERS", 12 * index + k, 0.0);
  }
  for (int k = 0; k < 3; ++k) platform.origin[k] = number("ORIGIN", 3 * index + k, 0.0);
  for (int k = 0; platform.type == 4 && k < 36; ++k) {
    platform.calibration(k % 6, k / 6) =
        number("CAL_MATRIX", 36 * index + k, k % 7 == 0 ? 1.0 : 0.0);
  }
  if (!platform.corners.allFinite() || !platform.origin.allFinite() ||
      !platform.calibration.allFinite()) {
    return PlatformError(file, index, "has corners, an origin or a calibration that is not finite");
  }
  return platform;
}

}  // namespace

int C3dFile::samples_per_frame() const {
  const int frames = num_frames();
  return analog.empty() || frames == 0 ? 0 : static_cast<int>(analog[0].samples.size()) / frames;
}

int C3dFile::FindPoint(std::string_view name) const {
  const auto found = std::find(point_names.begin(), point_names.end(), name);
  return found == point_names.end() ? -1 : static_cast<int>(found - point_names.begin());
}

int C3dFile::FindAnalog(std::string_view name) const {
  for (std::size_t i = 0; i < analog.size(); ++i) {
    if (analog[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<C3dEvent> ReadC3dEvents(const C3dParameters& parameters, const C3dBytes& bytes) {
  std::vector<C3dEvent> events;
  if (parameters.Find("EVENT", "TIMES") != nullptr) {
    const std::vector<double> times = parameters.Numbers("EVENT", "TIMES");
    const std::vector<std::string> labels = parameters.Texts("EVENT", "LABELS");
    const std::vector<std::string> contexts = parameters.Texts("EVENT", "CONTEXTS");
    const std::size_t count =
        std::min<std::size_t>(times.size() / 2, parameters.Whole("EVENT", "USED", 0, 0, 32767, 0));
    for (std::size_t i = 0; i < count; ++i) {
      events.push_back({60.0 * times[2 * i] + times[2 * i + 1], i < labels.size() ? labels[i] : "",
                        i < contexts.size() ? contexts[i] : ""});
    }
    return events;
  }
  const bool four_letters = bytes.Word(298) == kShortLabels;
  const int count = std::min<int>(bytes.Word(300), kHeaderEvents);
  for (int i = 0; four_letters && i < count; ++i) {
    const std::string_view label = bytes.Text(396 + 4 * i, 4);
    events.push_back(
        {bytes.Real(304 + 4 * i), std::string(Trimmed(label.substr(0, label.find('\0')))), ""});
  }
  return events;
}

MaybeError ReadC3dPlatforms(C3dFile* file) {
  const int used = file->parameters.Whole(kPlatforms, "USED", 0, 0, kMostPlatforms, 0);
  const C3dParameter* channels = file->parameters.Find(kPlatforms, "CHANNEL");
  if (used == 0 || channels == nullptr) return std::nullopt;
  file->platform_zero_first = file->parameters.Whole(kPlatforms, "ZERO", 0, 0, 1 << 30, 0);
  file->platform_zero_last = file->parameters.Whole(kPlatforms, "ZERO", 1, 0, 1 << 30, 0);
  const int stride = channels->dimensions.empty() ? 1 : channels->dimensions[0];
  for (int i = 0; i < used; ++i) {
    Result<C3dPlatform> platform = ReadPlatform(*file, i, stride);
    if (!platform.ok()) return platform.error();
    file->platforms.push_back(platform.value());
  }
  return std::nullopt;
}

namespace {

// The file's axis that the screen shows as up: "+Z" -> "+z"; empty when it is none.
std::string UpOfScreen(const std::string& screen_y) {
  if (screen_y.size() != 2 || (screen_y[0] != '+' && screen_y[0] != '-')) return "";
  const char axis = static_cast<char>(screen_y[1] | 0x20);
  return axis >= 'x' && axis <= 'z' ? std::string{screen_y[0], axis} : "";
}

}  // namespace

Result<PointMotion> ReadC3dPoints(const std::string& path, const PointReadOptions& options) {
  Result<C3dFile> read = ReadC3d(path, {options.accept_truncated});
  if (!read.ok()) return read.error();
  C3dFile& file = read.value();
  PointMotion motion;
  motion.path = path;
  motion.rate_hz = file.point_rate_hz;
  motion.unit_text = file.point_unit;
  motion.unit = FromName<LengthUnit>(file.point_unit);
  motion.up = UpOfScreen(file.screen_y);
  motion.names = std::move(file.point_names);
  motion.content_hash = file.content_hash;
  if (MaybeError failed = ChoosePoints(options, &motion)) return *std::move(failed);
  for (int index : motion.chosen) motion.positions.push_back(file.points[index]);
  return motion;
}

namespace {

constexpr char kGroup[] = "ROTATION";
constexpr std::size_t kReal = 4, kRealsOfPose = 17, kPoseColumns = 4;
constexpr int kMostSegments = 32767;
constexpr double kNoRotation = 0.1;  // of a determinant from 1

int Whole(const C3dFile& file, const char* name, int lowest, int highest, int fallback) {
  return file.parameters.Whole(kGroup, name, 0, lowest, highest, fallback);
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
  const double block = file->parameters.Number(kGroup, "DATA_START", 0, 0.0);
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
  std::vector<std::string> names = file->parameters.Texts(kGroup, "LABELS");
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
