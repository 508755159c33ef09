// datasets: a crowd's frame as a formation.
#include "datasets/exchange/crowd_places.h"

#include <algorithm>

#include "datasets/formats/motion_formats.h"

namespace pushid {

Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion, int frame) {
  if (frame < 0 || frame >= motion.num_frames()) {
    return Error{"there is no frame " + std::to_string(frame) + "; frames count from 0 to " +
                     std::to_string(motion.num_frames() - 1),
                 motion.path};
  }
  const double metres = MetresPer(motion.unit.value_or(LengthUnit::kMetre));
  std::vector<CrowdPlace> places;
  for (std::size_t i = 0; i < motion.chosen.size(); ++i) {
    const Eigen::Vector3d& position = motion.positions[i][frame];
    if (!position.allFinite()) continue;
    places.push_back({motion.names[motion.chosen[i]], metres * position.head<2>()});
  }
  if (places.empty()) {
    return Error{"nobody is there in frame " + std::to_string(frame), motion.path};
  }
  std::stable_sort(places.begin(), places.end(), [](const CrowdPlace& a, const CrowdPlace& b) {
    return a.position.x() != b.position.x() ? a.position.x() < b.position.x()
                                            : a.position.y() < b.position.y();
  });
  return places;
}

Result<std::vector<CrowdPlace>> ReadCrowdPlaces(const std::string& path, int frame) {
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (!format || !HoldsCrowd(*format)) {
    return Error{"trajectories of a crowd end in .txt or .sqlite", path};
  }
  const Result<PointMotion> motion = ReadPointMotion(path, *format);
  if (!motion.ok()) return motion.error();
  return PlacesAt(motion.value(), frame);
}

}  // namespace pushid
