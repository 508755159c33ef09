// datasets: ground that moves, from columns or from markers on it.
#include "datasets/loading/ground_record.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/sensors/sensor_choice.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr char kColumns[][6] = {"x", "y", "z", "theta", "phi"};
constexpr int kNumColumns = 5;
constexpr double kRestSeconds = 0.1;  // over which the speed at frame 0 is taken

// Columns by their names; -1: not there. up: of the column whose motion lifts, which is not read.
Result<std::vector<int>> GroundColumns(const std::string& path, int up,
                                       const std::vector<std::string>& names) {
  std::vector<int> columns;
  std::vector<std::string> wanted, known = {"time"};
  for (int i = 0; i < kNumColumns; ++i) {
    const auto found = std::find(names.begin(), names.end(), kColumns[i]);
    known.push_back(kColumns[i]);
    if (i != up) wanted.push_back(kColumns[i]);
    columns.push_back(found == names.end() || i == up ? -1
                                                      : static_cast<int>(found - names.begin()));
  }
  if (std::all_of(columns.begin(), columns.end(), [](int c) { return c < 0; })) {
    return Error{"none of the columns " + ListOfNames(wanted) + " is there; it has " +
                     ListOfNames(names) +
                     ". Name how the ground moves so: time,x,y,theta,phi (of level axes, "
                     "which \"up\" and \"forward\" name)",
                 path};
  }
  for (const std::string& name : names) {
    const std::string meant = Suggestion(name, known);
    if (meant.empty()) continue;
    return Error{"the column " + Quoted(name) + " is not known, and would be read as none" + meant +
                     " Columns of the ground are " + ListOfNames(known),
                 path};
  }
  return columns;
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

// The tracks' clock at frame 0, and that they last as long as the motion from there.
Result<double> GroundStart(const GroundTracks& tracks, const ManifestRecording& entry,
                           const Recording& recording) {
  // Markers have the rate that counts for the motion, whatever the file says.
  const double start = entry.ground.start_s.value_or(
      entry.ground.csv.empty() ? tracks.first_s + entry.first_frame / tracks.rate_hz
                               : recording.people[0].skipped_s);
  const double fps = recording.fps, seconds = (recording.num_frames() - 1) / fps;
  // Half a frame less is none.
  const RecordTimes times = {
      "the record of the ground lasts", tracks.first_s, tracks.last_s(), start, seconds, fps, 0.5};
  const int line = tracks.lines.empty() ? 0 : tracks.lines.back();
  if (MaybeError error = CheckLasts(times, tracks.file, line)) return *std::move(error);
  return start;
}

void LowPassTo(double fps, double lowpass_hz, GroundTracks* tracks) {
  const double highest = HighestCutoff(tracks->rate_hz);
  double cutoff = tracks->rate_hz > 1.05 * fps ? std::min(0.4 * fps, 0.9 * highest) : highest;
  if (lowpass_hz > 0.0) cutoff = std::min(cutoff, lowpass_hz);
  if (cutoff >= highest) return;
  LowPass(cutoff, tracks->rate_hz, &tracks->shift);
  LowPass(cutoff, tracks->rate_hz, &tracks->tilt);
}

// at: in samples, from 0.
GroundPose Sampled(const GroundTracks& tracks, double at) {
  const Eigen::Vector3d shift = ValueBetween(tracks.shift, at),
                        tilt = ValueBetween(tracks.tilt, at);
  return {shift[0], shift[1], tilt[0], tilt[1]};
}

// poses: at the recording's frames; start: the tracks' clock at the first of them.
MaybeError CheckAtRest(const GroundTracks& tracks, bool displacement, double start, double fps,
                       const std::vector<GroundPose>& poses) {
  // What was before frame 0 counts where the file has it: ground may start quickly at frame 0.
  const double first_at = (start - tracks.first_s) * tracks.rate_hz;
  const int rest = std::max(5, 1 + static_cast<int>(std::lround(kRestSeconds * tracks.rate_hz)));
  std::vector<GroundPose> about_first;
  double step = 1.0 / fps;
  if (first_at >= 4.0 && displacement) {
    step = 1.0 / tracks.rate_hz;
    for (int i = 0; i < rest && first_at - i >= 0.0; ++i) {
      about_first.push_back(Sampled(tracks, first_at - i));
    }
  } else {
    const int frames = std::max(5, 1 + static_cast<int>(std::lround(kRestSeconds * fps)));
    about_first.assign(poses.begin(),
                       poses.begin() + std::min(frames, static_cast<int>(poses.size())));
  }
  const double speed = GroundSpeedAtFirst(about_first, step);
  if (speed <= kGroundAtRest) return std::nullopt;
  return Error{"the ground moves by " + Rounded(speed, 2) +
                   " per second (m or rad) at frame 0, where people are taken to be at rest; "
                   "start the recording earlier (first_frame), or give the right clock at frame "
                   "0 as \"start\"",
               tracks.file, tracks.lines.empty() ? 0 : tracks.lines.front()};
}

using Track = std::vector<Eigen::Vector3d>;

constexpr double kGroundGap = 0.1;      // s, of a marker: longer ones are not filled
constexpr double kMarkersApart = 0.01;  // m, rms about a line: less tells no tilt about it

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
  const Eigen::VectorXd spread = DecomposeRight(AboutMiddle(marks, &middle)).values;
  const double off = spread[1] / std::sqrt(static_cast<double>(marks.size()));
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
  const Eigen::Matrix3d turn = NearestRotation(now * before.transpose());
  const Eigen::Vector3d normal = turn.col(2);  // where the ground's z points
  tracks->shift.push_back(b + turn * (under - a) - under);
  tracks->tilt.emplace_back(std::asin(std::clamp(normal[0], -1.0, 1.0)),
                            std::atan2(-normal[1], normal[2]), 0.0);
}

// A marker that slides, falls off or was exchanged for another moves the ground as it never moved.
MaybeError CheckRigid(const std::vector<Track>& marks, const ManifestGround& ground,
                      const std::string& path) {
  for (size_t a = 0; a < marks.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      double mean = 0.0, square = 0.0, farthest = 0.0;
      size_t at = 0;
      const auto frames = static_cast<double>(marks[a].size());
      for (size_t t = 0; t < marks[a].size(); ++t) mean += (marks[a][t] - marks[b][t]).norm();
      mean /= frames;
      for (size_t t = 0; t < marks[a].size(); ++t) {
        const double off = std::abs((marks[a][t] - marks[b][t]).norm() - mean);
        square += off * off / frames;
        if (off > farthest) farthest = off, at = t;
      }
      if (square <= kRigidMarkers * kRigidMarkers) continue;
      return Error{"the markers " + ground.markers[b] + " and " + ground.markers[a] +
                       " of the ground are not rigid: their distance scatters by " +
                       Rounded(1000.0 * std::sqrt(square), 2) + " mm about " +
                       Rounded(1000.0 * mean, 3) + " mm, most at frame " + std::to_string(at) +
                       ", and may by " + Rounded(1000.0 * kRigidMarkers) +
                       " mm; leave out the one that moves on the platform",
                   path};
    }
  }
  return std::nullopt;
}

// Short gaps are filled, and told; longer ones are errors.
MaybeError CloseGaps(const ManifestRecording& entry, const std::string& path, double rate,
                     std::vector<Track>* marks, Warnings* warnings) {
  for (size_t m = 0; m < marks->size(); ++m) {
    const std::string name = "the marker " + entry.ground.markers[m] + " of the ground";
    std::vector<double> weight((*marks)[m].size(), 1.0);
    const GapCount count =
        FillGaps(static_cast<int>(std::lround(kGroundGap * rate)), &(*marks)[m], &weight);
    const auto gap = std::find(weight.begin(), weight.end(), 0.0);
    if (gap != weight.end()) {
      return Error{name + " is not seen at frame " + std::to_string(gap - weight.begin()) +
                       " for longer than " + Rounded(kGroundGap) +
                       " s; fill the gap, or leave the marker out",
                   path};
    }
    if (count.gaps == 0 || warnings == nullptr) continue;
    const std::string told = name + " has " + std::to_string(count.gaps) +
                             (count.gaps == 1 ? " gap, " : " gaps, ") +
                             std::to_string(count.filled_frames) + " frames in all, filled by " +
                             (count.gaps == 1 ? "a cubic" : "cubics");
    warnings->emplace_back("recording " + Quoted(entry.id) + ": " + told, entry.id, told);
  }
  return std::nullopt;
}

Result<std::vector<Track>> ReadMarkers(const ManifestRecording& entry, const std::string& path,
                                       double* first_s) {
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
  *first_s = read.value().first_time_s;
  return read.value().positions;
}

}  // namespace

double GroundSpeedAtFirst(const std::vector<GroundPose>& poses, double dt) {
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
  const Eigen::Matrix<double, 3, 4> parabola =
      SolveLeastNorm(Eigen::MatrixXd(by), Eigen::MatrixXd(values));
  const Eigen::RowVector4d variance =
      (values - by * parabola).colwise().squaredNorm() / static_cast<double>(n - 3);
  const double by_scatter = std::sqrt((by.transpose() * by).inverse()(1, 1));
  const Eigen::RowVector4d slope =
      parabola.row(1).cwiseAbs() - 3.0 * by_scatter * variance.cwiseSqrt();
  return slope.cwiseMin(first).maxCoeff();
}

Result<GroundTracks> GroundOfCsv(const ManifestRecording& entry) {
  const ManifestGround& ground = entry.ground;
  const std::string path = ResolvePath(entry.manifest, ground.csv);
  const Eigen::Matrix3d axes = AxesRotation(ground.up.empty() ? "z" : ground.up,
                                            ground.forward.empty() ? "x" : ground.forward)
                                   .value();
  Eigen::Index up;  // the column of the file's axis that points up: lifting is not read
  axes.row(2).cwiseAbs().maxCoeff(&up);
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        return GroundColumns(path, static_cast<int>(up), names);
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

Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording, const GroundReading& reading,
                                           Warnings* warnings) {
  const ManifestGround& ground = entry.ground;
  Result<GroundTracks> read = ground.csv.empty()
                                  ? GroundOfMarkers(entry, recording, reading, warnings)
                                  : GroundOfCsv(entry);
  if (!read.ok()) return read.error();
  GroundTracks& tracks = read.value();
  const Result<double> start = GroundStart(tracks, entry, recording);
  if (!start.ok()) return start.error();
  const double fps = recording.fps;
  LowPassTo(fps, reading.lowpass_hz, &tracks);
  std::vector<GroundPose> poses;
  for (int t = 0; t < recording.num_frames(); ++t) {
    poses.push_back(Sampled(tracks, (start.value() + t / fps - tracks.first_s) * tracks.rate_hz));
  }
  Integrate(ground.quantity, 1.0 / fps, &poses);
  const GroundPose first = poses[0];
  for (GroundPose& pose : poses) pose -= first;
  const bool displacement = ground.quantity == GroundQuantity::kDisplacement;
  if (MaybeError moves = CheckAtRest(tracks, displacement, start.value(), fps, poses)) {
    return *std::move(moves);
  }
  return poses;
}

Result<GroundTracks> GroundOfMarkers(const ManifestRecording& entry, const Recording& recording,
                                     const GroundReading& reading, Warnings* warnings) {
  const std::string path = ResolvePath(entry.manifest, entry.motion[0]);
  GroundTracks tracks{path, reading.file_fps, 0.0, {}, {}, {}};
  Result<std::vector<Track>> read = ReadMarkers(entry, path, &tracks.first_s);
  if (!read.ok()) return read.error();
  std::vector<Track>& marks = read.value();
  if (MaybeError failed = CloseGaps(entry, path, tracks.rate_hz, &marks, warnings)) {
    return *std::move(failed);
  }
  const RecordedPerson& person = recording.people[0];
  const Eigen::Matrix3d axes = AxesRotation(person.file_up, person.file_forward).value();
  for (Track& mark : marks) {
    for (Eigen::Vector3d& v : mark) v = reading.metres_per_unit * (axes * v);
  }
  if (MaybeError failed = CheckRigid(marks, entry.ground, path)) return *std::move(failed);
  const auto at = [&](int frame) {
    std::vector<Eigen::Vector3d> now;
    for (const Track& mark : marks) now.push_back(mark[frame]);
    return now;
  };
  const int frames = static_cast<int>(marks[0].size());
  const int first = std::clamp(entry.first_frame, 0, frames - 1);
  if (MaybeError failed = CheckApart(at(first), entry.ground, path)) return *std::move(failed);
  const Eigen::Vector3d under = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  for (int t = 0; t < frames; ++t) AddRigid(at(first), at(t), under, &tracks);
  return tracks;
}

}  // namespace pushid
