// datasets: hips of recordings as trajectories.
#include "datasets/exchange/hip_trajectories.h"

#include <limits>

#include "datasets/formats/motion_formats.h"

namespace pushid {

PointMotion HipTrajectories(const Recording& recording) {
  PointMotion motion;
  motion.rate_hz = recording.fps;
  motion.unit = LengthUnit::kMetre;
  for (const RecordedPerson& person : recording.people) {
    motion.chosen.push_back(static_cast<int>(motion.names.size()));
    motion.names.push_back(person.subject_id);
    motion.positions.push_back(person.hip);
    for (std::size_t frame = 0; frame < person.weight.size(); ++frame) {
      if (person.weight[frame] > 0.0) continue;
      motion.positions.back()[frame].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return motion;
}

MaybeError WriteTrajectories(const std::string& path, const PointMotion& motion) {
  return MotionFormatOfFile(path) == MotionFormat::kTrajectorySqlite
             ? WriteTrajectorySqlite(path, motion)
             : WriteTrajectoryText(path, motion);
}

MaybeError CheckTrajectoryFile(const std::string& flag, const std::string& path) {
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (path.empty() || (format && HoldsCrowd(*format))) return std::nullopt;
  return Error{"--" + flag + " names " + path +
               "; trajectories end in .txt (PedPy, JuPedSim) or .sqlite (JuPedSim)"};
}

}  // namespace pushid
