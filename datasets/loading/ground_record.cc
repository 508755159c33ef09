// datasets: the ground from a table of numbers, and from markers.
#include "datasets/loading/ground_record.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/sensors/timed_columns.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr char kColumns[][6] = {"x", "y", "theta", "phi"};

// Shift and tilt, evenly sampled.
struct GroundTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  Track shift, tilt;         // z: nothing
  std::vector<int> lines{};  // of a file's rows
  double last_s() const { return first_s + (static_cast<double>(shift.size()) - 1.0) / rate_hz; }
};

Result<GroundTracks> FromCsv(const ManifestRecording& entry) {
  const std::string path = ResolvePath(entry.manifest, entry.ground.csv);
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        std::vector<int> columns;
        for (const char* wanted : kColumns) {
          const auto found = std::find(names.begin(), names.end(), wanted);
          columns.push_back(found == names.end() ? -1 : static_cast<int>(found - names.begin()));
        }
        if (std::all_of(columns.begin(), columns.end(), [](int c) { return c < 0; })) {
          return Error{"none of the columns x, y, theta and phi is there; it has " +
                           ListOfNames(names) +
                           ". Name how the ground moves so: time,x,y,theta,phi",
                       path};
        }
        return columns;
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  GroundTracks tracks{path, table.rate_hz, table.first_s, {}, {}, table.lines};
  for (int row = 0; row < table.num_rows(); ++row) {
    double value[4];
    for (int i = 0; i < 4; ++i) {
      value[i] = table.values[i].empty() ? 0.0 : table.values[i][row];
      if (std::isfinite(value[i])) continue;
      return Error{std::string(kColumns[i]) + " of the ground is missing; fill the gap", path,
                   table.lines[row]};
    }
    tracks.shift.emplace_back(value[0], value[1], 0.0);
    tracks.tilt.emplace_back(value[2], value[3], 0.0);
  }
  if (!entry.ground.up.empty() || !entry.ground.forward.empty()) {
    const auto& g = entry.ground;
    const Eigen::Matrix3d axes =
        AxesRotation(g.up.empty() ? "z" : g.up, g.forward.empty() ? "x" : g.forward).value();
    for (Eigen::Vector3d& v : tracks.shift) v = axes * v;
  }
  return tracks;
}

// The turn that takes the marks of frame 0 to those of a frame best (Kabsch 1976), and the shift of
// their middle.
void AddRigid(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
              GroundTracks* tracks) {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  for (size_t i = 0; i < from.size(); ++i) a += from[i], b += to[i];
  a /= static_cast<double>(from.size()), b /= static_cast<double>(from.size());
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < from.size(); ++i) h += (from[i] - a) * (to[i] - b).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d flip(1.0, 1.0, (svd.matrixV() * svd.matrixU().transpose()).determinant());
  const Eigen::Matrix3d turn = svd.matrixV() * flip.asDiagonal() * svd.matrixU().transpose();
  const Eigen::Vector3d normal = turn.col(2);  // where the ground's z points
  tracks->shift.emplace_back(b[0] - a[0], b[1] - a[1], 0.0);
  tracks->tilt.emplace_back(std::asin(std::clamp(normal[0], -1.0, 1.0)),
                            std::atan2(-normal[1], normal[2]), 0.0);
}

Result<GroundTracks> FromMarkers(const ManifestRecording& entry, const Recording& recording) {
  const std::string path = ResolvePath(entry.manifest, entry.motion[0]);
  PointReadOptions options;
  options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    std::vector<int> chosen;
    for (const std::string& marker : entry.ground.markers) {
      const auto found = std::find(names.begin(), names.end(), marker);
      if (found == names.end()) return UnknownNameError(path, "marker", names, marker);
      chosen.push_back(static_cast<int>(found - names.begin()));
    }
    return chosen;
  };
  const Result<PointMotion> read = ReadPointMotion(path, entry.motion_format, options);
  if (!read.ok()) return read.error();
  const PointMotion& motion = read.value();
  const RecordedPerson& person = recording.people[0];
  const double metres =
      entry.length_scale
          ? *entry.length_scale
          : MetresPer(entry.length_unit.value_or(motion.unit.value_or(LengthUnit::kMillimetre)));
  const Eigen::Matrix3d axes = AxesRotation(person.file_up, person.file_forward).value();
  const double rate = motion.rate_hz > 0.0 ? motion.rate_hz : entry.fps;
  GroundTracks tracks{path, rate, motion.first_time_s, {}, {}, {}};
  std::vector<Track> marks = motion.positions;
  for (size_t m = 0; m < marks.size(); ++m) {
    std::vector<double> weight(marks[m].size(), 1.0);
    FillGaps(static_cast<int>(std::lround(0.1 * rate)), &marks[m], &weight);
    const auto gap = std::find(weight.begin(), weight.end(), 0.0);
    if (gap != weight.end()) {
      return Error{"the marker " + entry.ground.markers[m] +
                       " of the ground is not seen at frame " +
                       std::to_string(gap - weight.begin()) +
                       " for longer than 0.1 s; fill the gap, or leave the marker out",
                   path};
    }
    for (Eigen::Vector3d& v : marks[m]) v = metres * (axes * v);
  }
  const auto at = [&](int frame) {
    std::vector<Eigen::Vector3d> now;
    for (const Track& mark : marks) now.push_back(mark[frame]);
    return now;
  };
  const int first = std::clamp(entry.first_frame, 0, motion.num_frames() - 1);
  for (int t = 0; t < motion.num_frames(); ++t) AddRigid(at(first), at(t), &tracks);
  return tracks;
}

// Rates into what they add up to, as GroundThrough takes it apart; at frames.
void Integrate(GroundQuantity quantity, double dt, std::vector<GroundPose>* poses) {
  if (quantity == GroundQuantity::kDisplacement) return;
  GroundPose velocity = GroundPose::Zero(), pose = GroundPose::Zero();
  for (GroundPose& given : *poses) {
    const GroundPose now = given;
    given = pose;
    velocity = quantity == GroundQuantity::kVelocity ? now : GroundPose(velocity + dt * now);
    pose += dt * velocity;
  }
}

}  // namespace

Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording) {
  const ManifestGround& ground = entry.ground;
  Result<GroundTracks> read = ground.csv.empty() ? FromMarkers(entry, recording) : FromCsv(entry);
  if (!read.ok()) return read.error();
  GroundTracks& tracks = read.value();
  const RecordedPerson& person = recording.people[0];
  const double start =
      ground.start_s.value_or(ground.csv.empty() ? person.file_clock_s : person.skipped_s);
  const double fps = recording.fps, seconds = (recording.num_frames() - 1) / fps;
  // Half a frame less is none.
  if (tracks.last_s() < start + seconds - 0.5 / fps || tracks.first_s > start + 0.5 / fps) {
    return Error{"the record of the ground lasts from " + Rounded(tracks.first_s, 4) + " to " +
                     Rounded(tracks.last_s(), 4) + " s, but the motion from " + Rounded(start, 4) +
                     " to " + Rounded(start + seconds, 4) +
                     " s of its clock; record it longer, cut the motion (end_frame), or give the "
                     "right clock at frame 0 as \"start\"",
                 tracks.file, tracks.lines.empty() ? 0 : tracks.lines.back()};
  }
  if (tracks.rate_hz > 1.05 * fps) {
    const double cutoff = std::min(0.4 * fps, 0.9 * HighestCutoff(tracks.rate_hz));
    LowPass(cutoff, tracks.rate_hz, &tracks.shift);
    LowPass(cutoff, tracks.rate_hz, &tracks.tilt);
  }
  std::vector<GroundPose> poses;
  for (int t = 0; t < recording.num_frames(); ++t) {
    const double at = (start + t / fps - tracks.first_s) * tracks.rate_hz;
    const Eigen::Vector3d shift = ValueBetween(tracks.shift, at),
                          tilt = ValueBetween(tracks.tilt, at);
    poses.push_back({shift[0], shift[1], tilt[0], tilt[1]});
  }
  Integrate(ground.quantity, 1.0 / fps, &poses);
  const GroundPose first = poses[0];
  for (GroundPose& pose : poses) pose -= first;
  // Over two steps: a quick start is none that was going on before.
  const double speed = poses.size() > 2 ? (poses[1] - poses[0]).cwiseAbs().maxCoeff() * fps : 0.0;
  const double before = (start - tracks.first_s) * tracks.rate_hz;
  const bool known_before = before >= 1.0 && ground.quantity == GroundQuantity::kDisplacement;
  const Eigen::Vector3d back = known_before
                                   ? Eigen::Vector3d((ValueBetween(tracks.shift, before) -
                                                      ValueBetween(tracks.shift, before - 1.0)) *
                                                     tracks.rate_hz)
                                   : Eigen::Vector3d::Zero();
  if ((known_before ? back.norm() : speed) > kGroundAtRest) {
    return Error{
        "the ground moves by " + Rounded(known_before ? back.norm() : speed, 2) +
            " per second (m or rad) at frame 0, where people are taken to be at rest; start "
            "the recording earlier (first_frame), or give the right clock at frame 0 as "
            "\"start\"",
        tracks.file, tracks.lines.empty() ? 0 : tracks.lines.front()};
  }
  return poses;
}

}  // namespace pushid
