// datasets: platforms of C3D files, and which file an entry means.
#include <algorithm>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/plate_record.h"
#include "datasets/sensors/force_platform.h"

namespace pushid {
namespace {

// How far outside of the corners a point is, m; in the file's axes and on the surface.
double Beyond(const Eigen::Matrix<double, 3, 4>& corners, const Eigen::Vector3d& point) {
  const Eigen::Vector3d centre = corners.rowwise().mean();
  double most = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d edge = corners.col((i + 1) % 4) - corners.col(i);
    Eigen::Vector3d out = 0.5 * (corners.col(i) + corners.col((i + 1) % 4)) - centre;
    out -= out.dot(edge) / edge.squaredNorm() * edge;
    if (out.norm() == 0.0) continue;
    most = std::max(most, (point - corners.col(i)).dot(out.normalized()));
  }
  return most;
}

}  // namespace

Result<PlateTracks> PlatesOfC3d(const std::string& path, const ManifestPlates& plates,
                                const Eigen::Matrix3d& axes) {
  const Result<C3dFile> read = ReadC3d(path);
  if (!read.ok()) return read.error();
  const C3dFile& file = read.value();
  std::vector<std::string> known, wanted = plates.plates;
  for (size_t i = 0; i < file.platforms.size(); ++i) {
    known.push_back("platform:" + std::to_string(i + 1));
  }
  if (known.empty()) return Error{"it has no force platform; name another \"file\"", path};
  if (wanted.empty()) wanted = known;
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value_or(LengthUnit::kMillimetre);
  PlateTracks tracks;
  tracks.file = path;
  tracks.rate_hz = file.analog_rate_hz;
  tracks.platforms = static_cast<int>(wanted.size());
  for (const std::string& name : wanted) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) return UnknownNameError(path, "platform", known, name);
    const int index = static_cast<int>(found - known.begin());
    const Result<PlatformRecord> platform = EvaluatePlatform(file, index, unit);
    if (!platform.ok()) return platform.error();
    const Eigen::Matrix<double, 3, 4> corners = file.platforms[index].corners * MetresPer(unit);
    int pressed = 0, outside = 0;
    double farthest = 0.0;
    for (size_t i = 0; i < platform.value().force.size(); ++i) {
      const Eigen::Vector3d& centre = platform.value().centre[i];
      tracks.Add(i, axes * platform.value().force[i], axes * centre);
      if (!centre.allFinite()) continue;
      const double beyond = Beyond(corners, centre);
      farthest = std::max(farthest, beyond);
      ++pressed;
      outside += beyond > kOffPlate;
    }
    if (2 * outside > pressed && pressed > 0) {
      return Error{"the centre of pressure of " + name + " is up to " + Rounded(farthest, 2) +
                       " m outside of its corners: are the channels' units (N mm, N m), the "
                       "corners, or a foot off the platform the reason?",
                   path};
    }
  }
  return tracks;
}

Result<PlateTracks> ReadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                               const RecordedPerson& person) {
  const bool of_motion = plates.file.empty();
  const std::string path = of_motion ? person.file : ResolvePath(entry.manifest, plates.file);
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (format == MotionFormat::kBvh || format == MotionFormat::kTrc) {
    return Error{std::string("a ") + RowOf(*format).title +
                     " file holds no force platforms; name the one that does as \"file\" of "
                     "force_plates (C3D, CSV, OpenSim storage)",
                 path};
  }
  const bool own_axes = of_motion && plates.up.empty() && plates.forward.empty();
  const std::string up = own_axes ? person.file_up : plates.up.empty() ? "z" : plates.up;
  const std::string forward = own_axes                 ? person.file_forward
                              : plates.forward.empty() ? "x"
                                                       : plates.forward;
  const Eigen::Matrix3d axes = AxesRotation(up, forward).value();
  return (format == MotionFormat::kC3d ? PlatesOfC3d : PlatesOfTable)(path, plates, axes);
}

}  // namespace pushid
