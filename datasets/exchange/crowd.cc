// datasets: crowds as formations, hips as crowds.
#include "datasets/exchange/crowd.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"

namespace pushid {

namespace {

constexpr double kFarApart = 5.0;  // m

}  // namespace

std::int64_t FirstFrame(const PointMotion& motion) {
  return std::llround(motion.first_time_s * motion.rate_hz);
}

Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion, std::int64_t frame) {
  const std::int64_t first = FirstFrame(motion), last = first + motion.num_frames() - 1;
  if (frame < first || frame > last) {
    return Error{"there is no frame " + std::to_string(frame) + "; the file has those from " +
                     std::to_string(first) + " to " + std::to_string(last),
                 motion.path};
  }
  const double metres = MetresPer(motion.unit.value_or(LengthUnit::kMetre));
  std::vector<CrowdPlace> places;
  for (std::size_t i = 0; i < motion.chosen.size(); ++i) {
    const Eigen::Vector3d& position = motion.positions[i][frame - first];
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

double MedianSpacing(const std::vector<CrowdPlace>& places) {
  if (places.size() < 2) return 0.0;
  std::vector<double> nearest;
  for (const CrowdPlace& one : places) {
    double distance = std::numeric_limits<double>::infinity();
    for (const CrowdPlace& other : places) {
      if (&other != &one) distance = std::min(distance, (one.position - other.position).norm());
    }
    nearest.push_back(distance);
  }
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

std::string OddSpacing(const std::vector<CrowdPlace>& places) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((places[i].position - places[k].position).norm() > kClosestPeople) continue;
      return "people " + places[k].name + " and " + places[i].name +
             " (the file's ids) are no more than 5 cm apart";
    }
  }
  const double spacing = MedianSpacing(places);
  if (spacing < kFarApart) return "";
  return "the nearest neighbour is " + Rounded(spacing, 3) +
         " m away (median); are the lengths metres? The comment '# id frame x/cm y/cm' declares cm";
}

Result<std::vector<CrowdPlace>> ReadCrowdPlaces(const std::string& path,
                                                std::optional<std::int64_t> frame) {
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (!format || !HoldsCrowd(*format)) {
    return Error{"trajectories of a crowd end in .txt or .sqlite", path};
  }
  const Result<PointMotion> motion = ReadPointMotion(path, *format);
  if (!motion.ok()) return motion.error();
  return PlacesAt(motion.value(), frame.value_or(FirstFrame(motion.value())));
}

PointMotion HipTrajectories(const Recording& recording) {
  PointMotion motion;
  motion.rate_hz = recording.fps;
  motion.unit = LengthUnit::kMetre;
  for (const RecordedPerson& person : recording.people) {
    motion.names.push_back(person.subject_id);
    motion.positions.push_back(person.hip);
    for (std::size_t frame = 0; frame < person.weight.size(); ++frame) {
      if (person.weight[frame] > 0.0) continue;
      motion.positions.back()[frame].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  ChoosePoints({}, &motion);
  return motion;
}

MaybeError WriteTrajectories(const std::string& path, const PointMotion& motion) {
  return RowOf(MotionFormatOfFile(path).value_or(MotionFormat::kTrajectoryText))
      .write_crowd(path, motion);
}

MaybeError CheckTrajectoryFile(const std::string& flag, const std::string& path) {
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (path.empty() || (format && HoldsCrowd(*format))) return std::nullopt;
  return Error{"--" + flag + " names " + path +
               "; trajectories end in .txt (PedPy, JuPedSim) or .sqlite (JuPedSim)"};
}

}  // namespace pushid
