// datasets: the ground from a table of numbers, and from markers.
#include "datasets/loading/ground_record.h"

#include <Eigen/LU>
#include <Eigen/QR>
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

constexpr char kColumns[][6] = {"x", "y", "z", "theta", "phi"};
constexpr int kNumColumns = 5;
constexpr double kRestSeconds = 0.1;    // over which the speed at frame 0 is taken
constexpr double kMarkersApart = 0.01;  // m, rms about a line: less tells no tilt about it

// Shift and tilt, evenly sampled.
struct GroundTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  Track shift, tilt;         // z: nothing
  std::vector<int> lines{};  // of a file's rows
  double last_s() const { return first_s + (static_cast<double>(shift.size()) - 1.0) / rate_hz; }
};

Result<GroundTracks> FromCsv(const ManifestRecording& entry) {
  const ManifestGround& ground = entry.ground;
  const std::string path = ResolvePath(entry.manifest, ground.csv);
  const Eigen::Matrix3d axes = AxesRotation(ground.up.empty() ? "z" : ground.up,
                                            ground.forward.empty() ? "x" : ground.forward)
                                   .value();
  Eigen::Index up;  // the column of the file's axis that points up: lifting is not read
  axes.row(2).cwiseAbs().maxCoeff(&up);
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        std::vector<int> columns;
        std::vector<std::string> wanted;
        for (int i = 0; i < kNumColumns; ++i) {
          const auto found = std::find(names.begin(), names.end(), kColumns[i]);
          const bool lifts = i == up;
          if (!lifts) wanted.push_back(kColumns[i]);
          columns.push_back(
              found == names.end() || lifts ? -1 : static_cast<int>(found - names.begin()));
        }
        if (std::all_of(columns.begin(), columns.end(), [](int c) { return c < 0; })) {
          return Error{"none of the columns " + ListOfNames(wanted) + " is there; it has " +
                           ListOfNames(names) +
                           ". Name how the ground moves so: time,x,y,theta,phi (of level axes, "
                           "which \"up\" and \"forward\" name)",
                       path};
        }
        return columns;
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  GroundTracks tracks{path, table.rate_hz, table.first_s, {}, {}, table.lines};
  for (int row = 0; row < table.num_rows(); ++row) {
    double value[kNumColumns];
    for (int i = 0; i < kNumColumns; ++i) {
      value[i] = table.values[i].empty() ? 0.0 : table.values[i][row];
      if (std::isfinite(value[i])) continue;
      return Error{std::string(kColumns[i]) + " of the ground is missing; fill the gap", path,
                   table.lines[row]};
    }
    tracks.shift.push_back(axes * Eigen::Vector3d(value[0], value[1], value[2]));
    tracks.tilt.emplace_back(value[3], value[4], 0.0);
  }
  return tracks;
}

Eigen::Matrix3Xd AboutMiddle(const std::vector<Eigen::Vector3d>& marks, Eigen::Vector3d* middle) {
  Eigen::Matrix3Xd about(3, marks.size());
  for (size_t i = 0; i < marks.size(); ++i) about.col(i) = marks[i];
  *middle = about.rowwise().mean();
  return about.colwise() - *middle;
}

// Marks on one line, or one named twice, leave the tilt about it open.
MaybeError CheckApart(const std::vector<Eigen::Vector3d>& marks, const ManifestGround& ground,
                      const std::string& path) {
  Eigen::Vector3d middle;
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(AboutMiddle(marks, &middle));
  const double off = svd.singularValues()[1] / std::sqrt(static_cast<double>(marks.size()));
  if (off >= kMarkersApart) return std::nullopt;
  return Error{"the markers of the ground (" + ListOfNames(ground.markers) +
                   ") lie on a line within " + Rounded(1000.0 * off, 2) +
                   " mm, which leaves the tilt about it open; name one beside it, " +
                   Rounded(1000.0 * kMarkersApart) + " mm or more",
               path};
}

// The turn that takes the marks of frame 0 to those of a frame best (Kabsch 1976), and where it and
// the shift of their middle take the point `under` the person, about which the ground tilts.
void AddRigid(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
              const Eigen::Vector3d& under, GroundTracks* tracks) {
  Eigen::Vector3d a, b;
  const Eigen::Matrix3Xd before = AboutMiddle(from, &a), now = AboutMiddle(to, &b);
  const Eigen::Matrix3d h = before * now.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d flip(1.0, 1.0, (svd.matrixV() * svd.matrixU().transpose()).determinant());
  const Eigen::Matrix3d turn = svd.matrixV() * flip.asDiagonal() * svd.matrixU().transpose();
  const Eigen::Vector3d normal = turn.col(2);  // where the ground's z points
  tracks->shift.push_back(b + turn * (under - a) - under);
  tracks->tilt.emplace_back(std::asin(std::clamp(normal[0], -1.0, 1.0)),
                            std::atan2(-normal[1], normal[2]), 0.0);
}

Result<GroundTracks> FromMarkers(const ManifestRecording& entry, const Recording& recording,
                                 const GroundReading& reading) {
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
  const Eigen::Matrix3d axes = AxesRotation(person.file_up, person.file_forward).value();
  const double rate = reading.file_fps;
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
    for (Eigen::Vector3d& v : marks[m]) v = reading.metres_per_unit * (axes * v);
  }
  const auto at = [&](int frame) {
    std::vector<Eigen::Vector3d> now;
    for (const Track& mark : marks) now.push_back(mark[frame]);
    return now;
  };
  const int first = std::clamp(entry.first_frame, 0, motion.num_frames() - 1);
  if (MaybeError failed = CheckApart(at(first), entry.ground, path)) return *std::move(failed);
  const Eigen::Vector3d under = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  for (int t = 0; t < motion.num_frames(); ++t) AddRigid(at(first), at(t), under, &tracks);
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

// How fast the ground is at the first of some poses, in the fastest coordinate, m/s or rad/s: the
// slope there of a parabola through them, less what the scatter about it explains (three standard
// errors), and no more than the first step, which is short where ground starts quickly from rest.
double SpeedAtFirst(const std::vector<GroundPose>& poses, double dt) {
  const int n = static_cast<int>(poses.size());
  if (n < 2) return 0.0;
  const Eigen::RowVector4d first = (poses[1] - poses[0]).cwiseAbs().transpose() / dt;
  if (n < 5) return first.maxCoeff();
  Eigen::MatrixX3d by(n, 3);
  Eigen::MatrixX4d values(n, 4);
  for (int i = 0; i < n; ++i) {
    by.row(i) << 1.0, i * dt, i * dt * i * dt;
    values.row(i) = poses[i].transpose();
  }
  const Eigen::Matrix<double, 3, 4> parabola = by.colPivHouseholderQr().solve(values);
  const Eigen::RowVector4d variance =
      (values - by * parabola).colwise().squaredNorm() / static_cast<double>(n - 3);
  const double by_scatter = std::sqrt((by.transpose() * by).inverse()(1, 1));
  const Eigen::RowVector4d slope =
      parabola.row(1).cwiseAbs() - 3.0 * by_scatter * variance.cwiseSqrt();
  return slope.cwiseMin(first).maxCoeff();
}

}  // namespace

Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording,
                                           const GroundReading& reading) {
  const ManifestGround& ground = entry.ground;
  Result<GroundTracks> read =
      ground.csv.empty() ? FromMarkers(entry, recording, reading) : FromCsv(entry);
  if (!read.ok()) return read.error();
  GroundTracks& tracks = read.value();
  const RecordedPerson& person = recording.people[0];
  // Of markers by the rate that counts for the motion, whatever the file says.
  const double start = ground.start_s.value_or(
      ground.csv.empty() ? tracks.first_s + entry.first_frame / tracks.rate_hz : person.skipped_s);
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
  double cutoff = tracks.rate_hz > 1.05 * fps
                      ? std::min(0.4 * fps, 0.9 * HighestCutoff(tracks.rate_hz))
                      : HighestCutoff(tracks.rate_hz);
  if (reading.lowpass_hz > 0.0) cutoff = std::min(cutoff, reading.lowpass_hz);
  if (cutoff < HighestCutoff(tracks.rate_hz)) {
    LowPass(cutoff, tracks.rate_hz, &tracks.shift);
    LowPass(cutoff, tracks.rate_hz, &tracks.tilt);
  }
  const auto sampled = [&](double at) {
    const Eigen::Vector3d shift = ValueBetween(tracks.shift, at),
                          tilt = ValueBetween(tracks.tilt, at);
    return GroundPose(shift[0], shift[1], tilt[0], tilt[1]);
  };
  std::vector<GroundPose> poses;
  for (int t = 0; t < recording.num_frames(); ++t) {
    poses.push_back(sampled((start + t / fps - tracks.first_s) * tracks.rate_hz));
  }
  Integrate(ground.quantity, 1.0 / fps, &poses);
  const GroundPose first = poses[0];
  for (GroundPose& pose : poses) pose -= first;
  // By what was before frame 0, where the file has it: ground may start quickly at frame 0.
  const double first_at = (start - tracks.first_s) * tracks.rate_hz;
  const int rest = std::max(5, 1 + static_cast<int>(std::lround(kRestSeconds * tracks.rate_hz)));
  std::vector<GroundPose> about_first;
  double step = 1.0 / fps;
  if (first_at >= 4.0 && ground.quantity == GroundQuantity::kDisplacement) {
    step = 1.0 / tracks.rate_hz;
    for (int i = 0; i < rest && first_at - i >= 0.0; ++i) {
      about_first.push_back(sampled(first_at - i));
    }
  } else {
    const int frames = std::max(5, 1 + static_cast<int>(std::lround(kRestSeconds * fps)));
    about_first.assign(poses.begin(),
                       poses.begin() + std::min(frames, static_cast<int>(poses.size())));
  }
  const double speed = SpeedAtFirst(about_first, step);
  if (speed > kGroundAtRest) {
    return Error{"the ground moves by " + Rounded(speed, 2) +
                     " per second (m or rad) at frame 0, where people are taken to be at rest; "
                     "start the recording earlier (first_frame), or give the right clock at frame "
                     "0 as \"start\"",
                 tracks.file, tracks.lines.empty() ? 0 : tracks.lines.front()};
  }
  return poses;
}

}  // namespace pushid
