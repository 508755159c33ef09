// datasets: rows of trajectories to points.
#include "datasets/formats/trajectory_rows.h"

#include <algorithm>
#include <limits>

namespace pushid {
namespace {

// People are there for a part of the time; a file of a few rows does not fill the memory.
constexpr double kMostFramesPerRow = 1000.0, kFewFrames = 1e6;

}  // namespace

bool TrajectoryRows::Add(std::int64_t person, std::int64_t frame, const Eigen::Vector3d& position) {
  const bool first = last_ < first_;
  first_ = first ? frame : std::min(first_, frame);
  last_ = first ? frame : std::max(last_, frame);
  return people_[person].emplace(frame, position).second;
}

MaybeError TrajectoryRows::Fill(const PointReadOptions& options, PointMotion* motion) const {
  if (people_.empty()) return Error{"the file contains no positions", motion->path};
  std::vector<const std::map<std::int64_t, Eigen::Vector3d>*> tracks;
  for (const auto& [id, track] : people_) {
    motion->chosen.push_back(static_cast<int>(motion->names.size()));
    motion->names.push_back(std::to_string(id));
    tracks.push_back(&track);
  }
  if (options.choose) {
    Result<std::vector<int>> chosen = options.choose(motion->names);
    if (!chosen.ok()) return chosen.error();
    motion->chosen = std::move(chosen.value());
  }
  // Differences of whole numbers as text has them may overflow.
  const double frames = static_cast<double>(last_) - static_cast<double>(first_) + 1.0;
  std::size_t rows = 0;
  for (const auto* track : tracks) rows += track->size();
  if (frames * static_cast<double>(motion->chosen.size()) >
      kFewFrames + kMostFramesPerRow * static_cast<double>(rows)) {
    return Error{"frames go from " + std::to_string(first_) + " to " + std::to_string(last_) +
                     ", which is too many for " + std::to_string(rows) + " rows",
                 motion->path};
  }
  motion->first_time_s = static_cast<double>(first_) / motion->rate_hz;
  const Eigen::Vector3d unseen =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int person : motion->chosen) {
    std::vector<Eigen::Vector3d> track(static_cast<std::size_t>(frames), unseen);
    for (const auto& [frame, position] : *tracks[person]) track[frame - first_] = position;
    motion->positions.push_back(std::move(track));
  }
  return std::nullopt;
}

}  // namespace pushid
