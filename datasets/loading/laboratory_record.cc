// datasets: ground that moves, from columns or from markers on it, and force platforms at the
// frames of a motion, from C3D files and tables.
#include "datasets/loading/laboratory_record.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/ground_markers.h"
#include "datasets/loading/motion_tracks.h"
#include "datasets/sensors/force_sensors.h"
#include "models/decompositions.h"
#include "models/ipm.h"

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

namespace {

MaybeError CheckWeight(const std::string& file, const RecordedPerson& person) {
  double vertical = 0.0;
  int seen = 0;
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    vertical += sample.force.z();
    ++seen;
  }
  if (seen == 0) {
    return Error{"the platforms are pressed with less than " + Rounded(kPressed) +
                     " N at every frame; are up and forward right, and the platforms named?",
                 file};
  }
  vertical /= seen;
  const double weight = person.mass_kg * kGravity;
  if (std::abs(vertical / weight - 1.0) <= kWeightTolerance) return std::nullopt;
  return Error{"the mean vertical force is " + Rounded(vertical, 4) + " N, but " +
                   Rounded(person.mass_kg, 4) + " kg weigh " + Rounded(weight, 4) + " N (" +
                   Rounded(100.0 * (vertical / weight - 1.0), 2) +
                   " %): correct mass_kg, the platform's gain or axes, or name the platform under "
                   "the other foot (\"plates\")",
               file};
}

double MeanDistance(const std::vector<PlateSample>& plates, const RecordedPerson& person) {
  double sum = 0.0;
  int seen = 0;
  for (size_t t = 0; t < plates.size() && t < person.left_ankle.size(); ++t) {
    if (plates[t].weight <= 0.0) continue;
    sum +=
        (plates[t].centre - 0.5 * (person.left_ankle[t] + person.right_ankle[t])).head<2>().norm();
    ++seen;
  }
  return sum / std::max(1, seen);
}

// In a file of several people, the named one must stand nearest to where platforms are pressed.
MaybeError CheckPerson(const std::string& file, const Recording& recording, int named) {
  const std::vector<PlateSample>& plates = recording.people[named].plates;
  const double own = MeanDistance(plates, recording.people[named]);
  for (size_t n = 0; n < recording.people.size(); ++n) {
    const double other = MeanDistance(plates, recording.people[n]);
    if (other >= own) continue;
    return Error{"the centre of pressure is " + Rounded(own, 2) + " m from the ankles of person " +
                     std::to_string(named) + " (" + recording.people[named].subject_id + "), but " +
                     Rounded(other, 2) + " m from those of person " + std::to_string(n) + " (" +
                     recording.people[n].subject_id +
                     "); give force_plates the right \"person\", or name their platforms "
                     "(\"plates\")",
                 file};
  }
  return std::nullopt;
}

MaybeError CheckCentre(const PlateTracks& tracks, const RecordedPerson& person) {
  int far = 0, seen = 0;
  for (size_t t = 0; t < person.plates.size() && t < person.left_ankle.size(); ++t) {
    if (person.plates[t].weight <= 0.0) continue;
    const Eigen::Vector3d feet = 0.5 * (person.left_ankle[t] + person.right_ankle[t]);
    far += (person.plates[t].centre - feet).head<2>().norm() > kFarFromFeet;
    ++seen;
  }
  if (2 * far <= seen) return std::nullopt;
  return Error{"the centre of pressure is " + Rounded(MeanDistance(person.plates, person), 2) +
                   " m from the ankles on average: platforms and markers must share their origin "
                   "and axes (up, forward), and centres must be in metres",
               tracks.file};
}

// The tracks' clock at frame 0, and that they last as long as the motion from there.
Result<double> PlatesStart(const PlateTracks& tracks, const ManifestPlates& plates,
                           const RecordedPerson& person, double fps, double seconds) {
  const bool of_motion = plates.file.empty() || tracks.file == person.file;
  const bool c3d = MotionFormatOfFile(tracks.file) == MotionFormat::kC3d;
  const double start =
      plates.start_s.value_or(of_motion && !c3d ? person.file_clock_s : person.skipped_s);
  const RecordTimes times = {
      "the platforms were recorded", tracks.first_s, tracks.last_s(), start, seconds, fps, 1.5};
  if (MaybeError error = CheckLasts(times, tracks.file, tracks.last_line)) return *std::move(error);
  return start;
}

// Samples at the frames, from the tracks' time `start` on; spread: how far a filter spreads what
// stands in for a centre that is not known, in samples.
std::vector<PlateSample> SampledAt(const PlateTracks& tracks, double start, double fps, int frames,
                                   double spread) {
  std::vector<PlateSample> samples;
  for (int t = 0; t < frames; ++t) {
    const double at = (start + t / fps - tracks.first_s) * tracks.rate_hz;
    const Eigen::Vector3d moment = ValueBetween(tracks.moment, at);
    PlateSample sample;
    sample.force = ValueBetween(tracks.force, at);
    const auto near = std::lower_bound(tracks.unknown.begin(), tracks.unknown.end(), at - spread);
    const bool known = near == tracks.unknown.end() || *near > at + spread;
    if (moment.z() >= kPressed && known) {
      sample.centre = {moment.x() / moment.z(), moment.y() / moment.z(), 0.0};
      sample.weight = 1.0;
    }
    samples.push_back(sample);
  }
  return samples;
}

// Columns of one platform: fx, fy, fz, then px, py, pz or mx, my, mz.
struct PlateColumns {
  static constexpr int kCount = 9, kMoments = 6;
  int index[kCount] = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
  bool Has(int from, int needed) const {
    return std::count_if(index + from, index + from + 3, [](int i) { return i >= 0; }) >= needed;
  }
  // Whether there are two coordinates of the centre, whichever of the file's axes are level.
  bool Complete() const { return Has(0, 3) && (Has(3, 2) || Has(kMoments, 3)); }
};

PlateColumns ColumnsOf(const std::string& prefix, const std::vector<std::string>& names) {
  constexpr const char* kEndings[PlateColumns::kCount][2] = {
      {"fx", "vx"}, {"fy", "vy"}, {"fz", "vz"}, {"px", "px"}, {"py", "py"},
      {"pz", "pz"}, {"mx", "mx"}, {"my", "my"}, {"mz", "mz"}};
  PlateColumns columns;
  for (int i = 0; i < PlateColumns::kCount; ++i) {
    for (const char* ending : kEndings[i]) {
      for (const std::string& between : {std::string(), std::string("_")}) {
        const auto found = std::find(names.begin(), names.end(), prefix + between + ending);
        if (found != names.end()) columns.index[i] = static_cast<int>(found - names.begin());
      }
    }
  }
  return columns;
}

// Whatever stands before the endings.
std::vector<std::string> PrefixesIn(const std::vector<std::string>& names) {
  std::vector<std::string> prefixes;
  for (const std::string& name : names) {
    if (name.size() < 2) continue;
    const std::string ending = name.substr(name.size() - 2);
    if (ending != "fx" && ending != "vx") continue;
    std::string prefix = name.substr(0, name.size() - 2);
    if (!prefix.empty() && prefix.back() == '_') prefix.pop_back();
    if (ColumnsOf(prefix, names).Complete() || !prefix.empty()) prefixes.push_back(prefix);
  }
  return prefixes;
}

// The columns of each platform that are read; up: the file's axis that points there.
Result<std::vector<PlateColumns>> PlateColumnsIn(const std::string& path,
                                                 const ManifestPlates& plates, int up,
                                                 const std::vector<std::string>& names) {
  std::vector<PlateColumns> all;
  for (const std::string& prefix : plates.plates.empty() ? PrefixesIn(names) : plates.plates) {
    PlateColumns columns = ColumnsOf(prefix, names);
    const std::string whose = prefix.empty() ? "the platform" : Quoted(prefix);
    const bool moments = !columns.Has(3, 2) && columns.Has(PlateColumns::kMoments, 3);
    if (moments && !plates.origin && columns.Has(0, 3)) {
      return Error{whose +
                       " has moments (mx, my, mz) and no centre of pressure; give the point "
                       "that they are about as \"origin\" of force_plates: [x, y, z] in m",
                   path};
    }
    // The centre's height is not needed, and may be empty.
    const bool by_moments = plates.origin && columns.Has(PlateColumns::kMoments, 3);
    const int unused = by_moments ? 3 : PlateColumns::kMoments;
    std::fill(columns.index + unused, columns.index + unused + 3, -1);
    columns.index[3 + up] = -1;
    if (!columns.Has(0, 3) || !columns.Has(by_moments ? PlateColumns::kMoments : 3, 2)) {
      return Error{"a column of " + whose +
                       " is missing: fx, fy, fz (or vx, vy, vz) and the two of px, py, pz that are "
                       "level are needed, or mx, my, mz and \"origin\"; it has " +
                       ListOfNames(names),
                   path};
    }
    all.push_back(columns);
  }
  if (!all.empty()) return all;
  return Error{
      "there are no columns of a force platform (time,fx,fy,fz,px,py, or "
      "time,fx,fy,fz,mx,my,mz); it has " +
          ListOfNames(names),
      path};
}

// The point where a force with this moment about the origin, all in the project's axes, meets the
// ground at height 0: M = r x F but for a moment about the vertical.
Eigen::Vector3d CentreByMoment(const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                               const Eigen::Vector3d& origin) {
  const double up = -origin.z();
  return {origin.x() + (up * force.x() - moment.y()) / force.z(),
          origin.y() + (up * force.y() + moment.x()) / force.z(), 0.0};
}

// A platform to stand on, whose surface faces up; `axes` turns the file's axes to the project's.
Result<PlatformRecord> OnTheFloor(const C3dFile& file, int index, LengthUnit unit,
                                  const Eigen::Matrix3d& axes) {
  Result<PlatformRecord> platform = EvaluatePlatform(file, index, unit);
  if (!platform.ok()) return platform;
  const std::string name = "platform:" + std::to_string(index + 1);
  if ((axes * platform.value().normal).z() < -0.5) {
    return Error{name +
                     " faces down: are up and forward right, and do CORNERS list its corners in "
                     "the order (+x, +y), (-x, +y), (-x, -y), (+x, -y)?",
                 file.path};
  }
  if (!platform.value().outside.empty()) return Error{platform.value().outside, file.path};
  return platform;
}

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
  std::optional<Error> failed;
  for (const std::string& name : wanted) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) return UnknownNameError(path, "platform", known, name);
    const Result<PlatformRecord> read_platform =
        OnTheFloor(file, static_cast<int>(found - known.begin()), unit, axes);
    if (!read_platform.ok()) {
      failed = read_platform.error();
      if (!plates.plates.empty()) return *failed;
      tracks.warnings.push_back(failed->message + "; it is left out");
      continue;
    }
    const PlatformRecord& platform = read_platform.value();
    tracks.warnings.insert(tracks.warnings.end(), platform.warnings.begin(),
                           platform.warnings.end());
    for (size_t i = 0; i < platform.force.size(); ++i) {
      tracks.Add(i, axes * platform.force[i], axes * platform.centre[i]);
    }
    ++tracks.platforms;
  }
  if (tracks.platforms == 0) return *failed;
  return tracks;
}

// Programs give no centre below a force of theirs, of which one that stands in is near enough.
constexpr double kLoaded = 30.0;       // N
constexpr double kNearOrigin = 0.005;  // m: there a centre may be zero

// Where the platform is pressed and its centre is not known, the one known before stands in, or the
// first; NaN where none is. The samples where this is so under load.
std::vector<double> FillCentres(const Track& force, Track* centre) {
  const auto pressed = [&](size_t i) { return force[i].z() >= kPressed; };
  const auto known = [&](size_t i) { return SeenPosition((*centre)[i]).allFinite(); };
  size_t last = 0;
  while (last + 1 < force.size() && !(pressed(last) && known(last))) ++last;
  std::vector<double> unknown;
  for (size_t i = 0; i < force.size(); ++i) {
    if (!pressed(i)) continue;
    if (known(i)) last = i;
    const Eigen::Vector3d stands_in = SeenPosition((*centre)[last]);
    if (known(i) || ((*centre)[i].isZero(0.0) && stands_in.norm() < kNearOrigin)) continue;
    (*centre)[i] = stands_in;
    if (force[i].z() >= kLoaded) unknown.push_back(static_cast<double>(i));
  }
  return unknown;
}

Result<PlateTracks> PlatesOfTable(const std::string& path, const ManifestPlates& plates,
                                  const Eigen::Matrix3d& axes) {
  Eigen::Index up;
  axes.row(2).cwiseAbs().maxCoeff(&up);
  std::vector<PlateColumns> all;
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        const auto chosen = PlateColumnsIn(path, plates, static_cast<int>(up), names);
        if (!chosen.ok()) return chosen.error();
        all = chosen.value();
        std::vector<int> columns;
        for (const PlateColumns& one : all) {
          columns.insert(columns.end(), one.index, one.index + PlateColumns::kCount);
        }
        return columns;
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  PlateTracks tracks;
  tracks.file = path;
  tracks.rate_hz = table.rate_hz;
  tracks.first_s = table.first_s;
  tracks.last_line = table.lines.back();
  tracks.platforms = static_cast<int>(all.size());
  const auto at = [&](size_t plate, int first, int row) {
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double>& column =
          table.values[PlateColumns::kCount * plate + static_cast<size_t>(first + i)];
      value[i] = column.empty() ? 0.0 : column[static_cast<size_t>(row)];
    }
    return Eigen::Vector3d(axes * value);
  };
  for (size_t plate = 0; plate < all.size(); ++plate) {
    const bool by_moments = all[plate].Has(PlateColumns::kMoments, 3);
    // Files hold the force on the person or on the platform, which can only be pressed.
    double vertical = 0.0;
    for (int row = 0; row < table.num_rows(); ++row) vertical += at(plate, 0, row).z();
    const double sign = vertical < 0.0 ? -1.0 : 1.0;
    const std::string whose = path + ": platform " + std::to_string(plate + 1);
    if (sign < 0.0 && !by_moments) {
      tracks.warnings.push_back(whose +
                                " is pulled by the sign of its force, which is taken as that on "
                                "the platform; is \"up\" right?");
    }
    Track force, centre;
    for (int row = 0; row < table.num_rows(); ++row) {
      force.push_back(sign * at(plate, 0, row));
      if (!force.back().allFinite()) {
        return Error{"a force of the platform is missing; fill the gap", path,
                     table.lines[static_cast<size_t>(row)]};
      }
      centre.push_back(by_moments ? CentreByMoment(force.back(),
                                                   sign * at(plate, PlateColumns::kMoments, row),
                                                   axes * *plates.origin)
                                  : at(plate, 3, row));
    }
    const std::vector<double> unknown = FillCentres(force, &centre);
    for (size_t i = 0; i < force.size(); ++i) tracks.Add(i, force[i], centre[i]);
    if (unknown.empty()) continue;
    tracks.unknown.insert(tracks.unknown.end(), unknown.begin(), unknown.end());
    const int first = table.lines[static_cast<size_t>(unknown[0])];
    const std::string lacks = " is pressed and has no centre of pressure (empty, nan or zeros)";
    if (!centre[static_cast<size_t>(unknown[0])].allFinite()) {
      return Error{"platform " + std::to_string(plate + 1) + lacks + " in any row", path, first};
    }
    tracks.warnings.push_back(whose + lacks + " in " + std::to_string(unknown.size()) +
                              " rows, from line " + std::to_string(first) +
                              " on: frames there do not count");
  }
  std::sort(tracks.unknown.begin(), tracks.unknown.end());
  return tracks;
}

}  // namespace

MaybeError CheckPlates(const std::string& file, const Recording& recording, int person) {
  if (MaybeError error = CheckWeight(file, recording.people[person])) return error;
  return CheckPerson(file, recording, person);
}

MaybeError LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                      double lowpass_hz, Recording* recording, Warnings* warnings) {
  if (plates.use == PlateUse::kNone) return std::nullopt;
  RecordedPerson& person = recording->people[plates.person];
  Result<PlateTracks> read = ReadPlates(entry, plates, person);
  if (!read.ok()) return read.error();
  PlateTracks& tracks = read.value();
  for (size_t i = 0; warnings != nullptr && i < tracks.warnings.size(); ++i) {
    warnings->emplace_back("recording " + Quoted(entry.id) + ": " + tracks.warnings[i], entry.id,
                           tracks.warnings[i]);
  }
  const double fps = recording->fps, seconds = (recording->num_frames() - 1) / fps;
  const Result<double> start = PlatesStart(tracks, plates, person, fps, seconds);
  if (!start.ok()) return start.error();
  double cutoff = plates.lowpass_hz > 0.0 ? plates.lowpass_hz : 0.4 * fps;
  if (lowpass_hz > 0.0) cutoff = std::min(cutoff, lowpass_hz);
  const bool filtered = cutoff < HighestCutoff(tracks.rate_hz);
  if (filtered) {
    LowPass(cutoff, tracks.rate_hz, &tracks.force);
    LowPass(cutoff, tracks.rate_hz, &tracks.moment);
  }
  person.plates = SampledAt(tracks, start.value(), fps, recording->num_frames(),
                            filtered ? tracks.rate_hz / cutoff : 1.0);
  if (MaybeError error = CheckPlates(tracks.file, *recording, plates.person)) return error;
  // With platforms alone the feet are not seen; on ground that moves they go with it.
  const bool feet_seen = recording->ground.empty() && !entry.plates_alone;
  return feet_seen ? CheckCentre(tracks, person) : std::nullopt;
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
