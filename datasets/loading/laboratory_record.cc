// datasets: ground that moves, from columns, and force platforms at the frames of a motion, from
// C3D files and tables.
#include "datasets/loading/laboratory_record.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
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
std::vector<int> GroundColumns(const std::string& path, int up,
                               const std::vector<std::string>& names) {
  std::vector<int> columns;
  std::vector<std::string> wanted, known = {"time"};
  for (int i = 0; i < kNumColumns; ++i) {
    const auto found = std::find(names.begin(), names.end(), kColumns[i]);
    known.push_back(kColumns[i]);
    if (i != up) wanted.push_back(kColumns[i]);
    const bool read = i != up && found != names.end();
    columns.push_back(read ? static_cast<int>(found - names.begin()) : -1);
  }
  if (*std::max_element(columns.begin(), columns.end()) < 0) {
    throw Error{"none of the columns " + ListOfNames(wanted) + " is there; it has " +
                    ListOfNames(names) +
                    ". Name how the ground moves so: time,x,y,theta,phi (of level axes, "
                    "which \"up\" and \"forward\" name)",
                path};
  }
  for (const std::string& name : names) {
    const std::string meant = Suggestion(name, known);
    if (meant.empty()) continue;
    throw Error{"the column " + Quoted(name) + " is not known, and would be read as none" + meant +
                    " Columns of the ground are " + ListOfNames(known),
                path};
  }
  return columns;
}

// Sums rates up, as GroundThrough takes the sum apart; at frames.
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

// Throws an Error unless the record, of which `lasts` begins to tell, goes on from the clock's
// `start` on for as long as the motion. spare: frames that may be missing at the end.
void CheckLasts(const EvenRecord& record, const std::string& lasts, double start, double spare,
                const Recording& recording) {
  const double frame = 1.0 / recording.fps;
  const double end = start + (recording.num_frames() - 1) / recording.fps;
  if (record.first_s <= start + 0.5 * frame && record.last_s() >= end - spare * frame) return;
  throw Error{lasts + " from " + Rounded(record.first_s, 4) + " to " + Rounded(record.last_s(), 4) +
                  " s, but the motion from " + Rounded(start, 4) + " to " + Rounded(end, 4) +
                  " s of that clock; record it longer, cut the motion (end_frame), or give the "
                  "right clock at frame 0 as \"start\"",
              record.file, record.last_line};
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
void CheckAtRest(const GroundTracks& tracks, bool displacement, double start, double fps,
                 const std::vector<GroundPose>& poses) {
  // The file's rows before frame 0 count where there are some: ground may start quickly at frame 0.
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
  if (speed <= kGroundAtRest) return;
  throw Error{"the ground moves by " + Rounded(speed, 2) +
                  " per second (m or rad) at frame 0, where people are taken to be at rest; "
                  "start the recording earlier (first_frame), or give the right clock at frame "
                  "0 as \"start\"",
              tracks.file, tracks.first_line};
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

GroundTracks GroundOfCsv(const ManifestRecording& entry) {
  const ManifestGround& ground = entry.ground;
  const std::string path = ResolvePath(entry.manifest, ground.csv);
  const Eigen::Matrix3d axes = AxesGiven(ground.up, ground.forward);
  Eigen::Index up;  // the column of the file's axis that points up: lifting is not read
  axes.row(2).cwiseAbs().maxCoeff(&up);
  const TimedColumns table = ReadTimedColumns(path, [&](const std::vector<std::string>& names) {
    return GroundColumns(path, static_cast<int>(up), names);
  });
  GroundTracks tracks{
      {path, table.rate_hz, table.first_s, table.lines.front(), table.lines.back()}};
  for (int row = 0; row < table.num_rows(); ++row) {
    double value[kNumColumns];
    for (int i = 0; i < kNumColumns; ++i) {
      value[i] = table.values[i].empty() ? 0.0 : table.values[i][row];
      if (std::isfinite(value[i])) continue;
      throw Error{std::string(kColumns[i]) + " of the ground is missing; fill the gap", path,
                  table.lines[row]};
    }
    tracks.shift.push_back(axes * Eigen::Vector3d(value[0], value[1], value[2]));
    tracks.tilt.emplace_back(value[3], value[4], 0.0);
  }
  tracks.samples = tracks.shift.size();
  return tracks;
}

Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording, double lowpass_hz) {
  return Caught([&] {
    const ManifestGround& ground = entry.ground;
    GroundTracks tracks = GroundOfCsv(entry);
    const double start = ground.start_s.value_or(recording.people[0].skipped_s);
    CheckLasts(tracks, "the record of the ground lasts", start, 0.5, recording);
    const double fps = recording.fps;
    LowPassTo(fps, lowpass_hz, &tracks);
    std::vector<GroundPose> poses;
    for (int t = 0; t < recording.num_frames(); ++t) {
      poses.push_back(Sampled(tracks, (start + t / fps - tracks.first_s) * tracks.rate_hz));
    }
    Integrate(ground.quantity, 1.0 / fps, &poses);
    const GroundPose first = poses[0];
    for (GroundPose& pose : poses) pose -= first;
    CheckAtRest(tracks, ground.quantity == GroundQuantity::kDisplacement, start, fps, poses);
    return poses;
  });
}

namespace {

using Track = std::vector<Eigen::Vector3d>;

void CheckWeight(const std::string& file, const RecordedPerson& person) {
  double vertical = 0.0;
  int seen = 0;
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    vertical += sample.force.z();
    ++seen;
  }
  if (seen == 0) {
    throw Error{"the platforms are pressed with less than " + Rounded(kPressed) +
                    " N at every frame; are up and forward right, and the platforms named?",
                file};
  }
  vertical /= seen;
  const double weight = person.mass_kg * kGravity;
  if (std::abs(vertical / weight - 1.0) <= kWeightTolerance) return;
  throw Error{"the mean vertical force is " + Rounded(vertical, 4) + " N, but " +
                  Rounded(person.mass_kg, 4) + " kg weigh " + Rounded(weight, 4) + " N (" +
                  Rounded(100.0 * (vertical / weight - 1.0), 2) +
                  " %): correct mass_kg, the platform's gain or axes, or name the platform under "
                  "the other foot (\"plates\")",
              file};
}

// Distances of the centre of pressure from the middle of a person's ankles, m, where it is known.
std::vector<double> Distances(const std::vector<PlateSample>& plates,
                              const RecordedPerson& person) {
  std::vector<double> distances;
  for (size_t t = 0; t < plates.size() && t < person.left_ankle.size(); ++t) {
    if (plates[t].weight <= 0.0) continue;
    const Eigen::Vector3d feet = 0.5 * (person.left_ankle[t] + person.right_ankle[t]);
    distances.push_back((plates[t].centre - feet).head<2>().norm());
  }
  return distances;
}

double MeanDistance(const std::vector<PlateSample>& plates, const RecordedPerson& person) {
  const std::vector<double> all = Distances(plates, person);
  return std::accumulate(all.begin(), all.end(), 0.0) / std::max<double>(1.0, all.size());
}

// In a file of several people, the named one must stand nearest to where platforms are pressed.
void CheckPerson(const std::string& file, const Recording& recording, int named) {
  const auto& people = recording.people;
  const double own = MeanDistance(people[named].plates, people[named]);
  for (size_t n = 0; n < people.size(); ++n) {
    const double other = MeanDistance(people[named].plates, people[n]);
    if (other >= own) continue;
    throw Error{
        StrCat("the centre of pressure is ", Rounded(own, 2), " m from the ankles of person ",
               named, " (", people[named].subject_id, "), but ", Rounded(other, 2),
               " m from those of person ", n, " (", people[n].subject_id,
               "); give force_plates the right \"person\", or name their platforms "
               "(\"plates\")"),
        file};
  }
}

void CheckCentre(const std::string& file, const RecordedPerson& person) {
  const std::vector<double> all = Distances(person.plates, person);
  const auto far = std::count_if(all.begin(), all.end(),
                                 [](double distance) { return distance > kFarFromFeet; });
  if (2 * far <= static_cast<long>(all.size())) return;
  throw Error{"the centre of pressure is " + Rounded(MeanDistance(person.plates, person), 2) +
                  " m from the ankles on average: platforms and markers must share their origin "
                  "and axes (up, forward), and centres must be in metres",
              file};
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

// Columns of one platform: fx, fy, fz, then px, py, pz, and mx, my, mz; -1: not there.
struct PlateColumns {
  static constexpr int kForce = 0, kCentre = 3, kMoments = 6, kCount = 9;
  int index[kCount];
  int Count(int from) const {
    return static_cast<int>(
        std::count_if(index + from, index + from + 3, [](int i) { return i >= 0; }));
  }
};

PlateColumns ColumnsOf(const std::string& prefix, const std::vector<std::string>& names) {
  constexpr const char* kEndings[PlateColumns::kCount][2] = {
      {"fx", "vx"}, {"fy", "vy"}, {"fz", "vz"}, {"px", "px"}, {"py", "py"},
      {"pz", "pz"}, {"mx", "mx"}, {"my", "my"}, {"mz", "mz"}};
  PlateColumns columns;
  for (int i = 0; i < PlateColumns::kCount; ++i) {
    columns.index[i] = -1;
    for (const std::string ending : kEndings[i]) {
      for (const std::string& name : {prefix + ending, prefix + "_" + ending}) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found != names.end()) columns.index[i] = static_cast<int>(found - names.begin());
      }
    }
  }
  return columns;
}

// The texts before the endings of forces; the empty one only where the columns are complete, with
// two coordinates of the centre, whichever of the file's axes are level.
std::vector<std::string> PrefixesIn(const std::vector<std::string>& names) {
  std::vector<std::string> prefixes;
  for (const std::string& name : names) {
    if (!EndsWith(name, "fx") && !EndsWith(name, "vx")) continue;
    std::string prefix = name.substr(0, name.size() - 2);
    if (!prefix.empty() && prefix.back() == '_') prefix.pop_back();
    const PlateColumns columns = ColumnsOf(prefix, names);
    const bool complete =
        columns.Count(PlateColumns::kForce) == 3 &&
        (columns.Count(PlateColumns::kCentre) >= 2 || columns.Count(PlateColumns::kMoments) == 3);
    if (complete || !prefix.empty()) prefixes.push_back(prefix);
  }
  return prefixes;
}

// The columns of each platform that are read; up: the file's axis that points there.
std::vector<PlateColumns> PlateColumnsIn(const std::string& path, const ManifestPlates& plates,
                                         int up, const std::vector<std::string>& names) {
  std::vector<PlateColumns> all;
  for (const std::string& prefix : plates.plates.empty() ? PrefixesIn(names) : plates.plates) {
    PlateColumns& columns = all.emplace_back(ColumnsOf(prefix, names));
    const std::string whose = prefix.empty() ? "the platform" : Quoted(prefix);
    const bool force = columns.Count(PlateColumns::kForce) == 3,
               moments = columns.Count(PlateColumns::kMoments) == 3;
    if (force && moments && !plates.origin && columns.Count(PlateColumns::kCentre) < 2) {
      throw Error{whose +
                      " has moments (mx, my, mz) and no centre of pressure; give the point "
                      "that they are about as \"origin\" of force_plates: [x, y, z] in m",
                  path};
    }
    // The centre's height is not needed, and may be empty.
    const bool by_moments = plates.origin && moments;
    const int unused = by_moments ? PlateColumns::kCentre : PlateColumns::kMoments;
    std::fill_n(columns.index + unused, 3, -1);
    columns.index[PlateColumns::kCentre + up] = -1;
    if (force && (by_moments || columns.Count(PlateColumns::kCentre) == 2)) continue;
    throw Error{"a column of " + whose +
                    " is missing: fx, fy, fz (or vx, vy, vz) and the two of px, py, pz that are "
                    "level are needed, or mx, my, mz and \"origin\"; it has " +
                    ListOfNames(names),
                path};
  }
  if (!all.empty()) return all;
  throw Error{
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
PlatformRecord OnTheFloor(const C3dFile& file, int index, LengthUnit unit,
                          const Eigen::Matrix3d& axes) {
  PlatformRecord platform = OrThrow(EvaluatePlatform(file, index, unit));
  if ((axes * platform.normal).z() < -0.5) {
    throw Error{StrCat("platform:", index + 1,
                       " faces down: are up and forward right, and do CORNERS list its corners in "
                       "the order (+x, +y), (-x, +y), (-x, -y), (+x, -y)?"),
                file.path};
  }
  if (!platform.outside.empty()) throw Error{platform.outside, file.path};
  return platform;
}

PlateTracks PlatesOfC3d(const std::string& path, const ManifestPlates& plates,
                        const Eigen::Matrix3d& axes) {
  const C3dFile file = OrThrow(ReadC3d(path));
  std::vector<std::string> known;
  for (size_t i = 0; i < file.platforms.size(); ++i) {
    known.push_back(StrCat("platform:", i + 1));
  }
  if (known.empty()) throw Error{"it has no force platform; name another \"file\"", path};
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value_or(LengthUnit::kMillimetre);
  PlateTracks tracks{{path, file.analog_rate_hz}};
  std::optional<Error> failed;
  for (const std::string& name : plates.plates.empty() ? known : plates.plates) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw UnknownNameError(path, "platform", known, name);
    const auto read = Caught(
        [&] { return OnTheFloor(file, static_cast<int>(found - known.begin()), unit, axes); });
    if (!read.ok()) {
      failed = read.error();
      if (!plates.plates.empty()) throw *failed;
      tracks.warnings.push_back(failed->message + "; it is left out");
      continue;
    }
    const PlatformRecord& platform = read.value();
    tracks.warnings.insert(tracks.warnings.end(), platform.warnings.begin(),
                           platform.warnings.end());
    for (size_t i = 0; i < platform.force.size(); ++i) {
      tracks.Add(i, axes * platform.force[i], axes * platform.centre[i]);
    }
    ++tracks.platforms;
  }
  if (tracks.platforms == 0) throw *failed;
  return tracks;
}

// Programs give no centre below a force of theirs, of which one that stands in is near enough.
constexpr double kLoaded = 30.0;       // N
constexpr double kNearOrigin = 0.005;  // m: there a centre may be zero

// Puts the centre known before, or the first, in the place of those that are not known while the
// platform is pressed; NaN where none is. Returns the samples where this is so under load.
std::vector<int> FillCentres(const Track& force, Track* centre) {
  const auto pressed = [&](size_t i) { return force[i].z() >= kPressed; };
  const auto known = [&](size_t i) { return SeenPosition((*centre)[i]).allFinite(); };
  size_t last = 0;
  while (last + 1 < force.size() && !(pressed(last) && known(last))) ++last;
  std::vector<int> unknown;
  for (size_t i = 0; i < force.size(); ++i) {
    if (!pressed(i)) continue;
    if (known(i)) last = i;
    const Eigen::Vector3d stands_in = SeenPosition((*centre)[last]);
    if (known(i) || ((*centre)[i].isZero(0.0) && stands_in.norm() < kNearOrigin)) continue;
    (*centre)[i] = stands_in;
    if (force[i].z() >= kLoaded) unknown.push_back(static_cast<int>(i));
  }
  return unknown;
}

PlateTracks PlatesOfTable(const std::string& path, const ManifestPlates& plates,
                          const Eigen::Matrix3d& axes) {
  Eigen::Index up;
  axes.row(2).cwiseAbs().maxCoeff(&up);
  std::vector<PlateColumns> all;
  const TimedColumns table = ReadTimedColumns(path, [&](const std::vector<std::string>& names) {
    all = PlateColumnsIn(path, plates, static_cast<int>(up), names);
    std::vector<int> columns;
    for (const PlateColumns& one : all) {
      columns.insert(columns.end(), one.index, one.index + PlateColumns::kCount);
    }
    return columns;
  });
  PlateTracks tracks{{path, table.rate_hz, table.first_s, table.lines.front(), table.lines.back()}};
  tracks.platforms = static_cast<int>(all.size());
  const auto at = [&](size_t plate, int first, int row) {
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double>& column = table.values[PlateColumns::kCount * plate + first + i];
      value[i] = column.empty() ? 0.0 : column[row];
    }
    return Eigen::Vector3d(axes * value);
  };
  for (size_t plate = 0; plate < all.size(); ++plate) {
    const bool by_moments = all[plate].Count(PlateColumns::kMoments) == 3;
    // Files hold the force on the person or on the platform, which can only be pressed.
    double vertical = 0.0;
    for (int row = 0; row < table.num_rows(); ++row) vertical += at(plate, 0, row).z();
    const double sign = vertical < 0.0 ? -1.0 : 1.0;
    const std::string number = StrCat("platform ", plate + 1);
    if (sign < 0.0 && !by_moments) {
      tracks.warnings.push_back(path + ": " + number +
                                " is pulled by the sign of its force, which is taken as that on "
                                "the platform; is \"up\" right?");
    }
    Track force, centre;
    for (int row = 0; row < table.num_rows(); ++row) {
      force.push_back(sign * at(plate, PlateColumns::kForce, row));
      if (!force.back().allFinite()) {
        throw Error{"a force of the platform is missing; fill the gap", path, table.lines[row]};
      }
      centre.push_back(by_moments ? CentreByMoment(force.back(),
                                                   sign * at(plate, PlateColumns::kMoments, row),
                                                   axes * *plates.origin)
                                  : at(plate, PlateColumns::kCentre, row));
    }
    const std::vector<int> unknown = FillCentres(force, &centre);
    for (size_t i = 0; i < force.size(); ++i) tracks.Add(i, force[i], centre[i]);
    if (unknown.empty()) continue;
    tracks.unknown.insert(tracks.unknown.end(), unknown.begin(), unknown.end());
    const int first = table.lines[unknown[0]];
    const std::string lacks =
        number + " is pressed and has no centre of pressure (empty, nan or zeros)";
    if (!centre[unknown[0]].allFinite()) throw Error{lacks + " in any row", path, first};
    tracks.warnings.push_back(StrCat(path, ": ", lacks, " in ", unknown.size(), " rows, from line ",
                                     first, " on: frames there do not count"));
  }
  std::sort(tracks.unknown.begin(), tracks.unknown.end());
  return tracks;
}

}  // namespace

void CheckPlates(const std::string& file, const Recording& recording, int person) {
  CheckWeight(file, recording.people[person]);
  CheckPerson(file, recording, person);
}

void LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates, double lowpass_hz,
                Recording* recording, Warnings* warnings) {
  if (plates.use == PlateUse::kNone) return;
  RecordedPerson& person = recording->people[plates.person];
  PlateTracks tracks = ReadPlates(entry, plates, person);
  for (const std::string& warning : tracks.warnings) WarnOf(entry.id, warning, warnings);
  const bool clock_of_motion = (plates.file.empty() || tracks.file == person.file) &&
                               MotionFormatOfFile(tracks.file) != MotionFormat::kC3d;
  const double start =
      plates.start_s.value_or(clock_of_motion ? person.file_clock_s : person.skipped_s);
  CheckLasts(tracks, "the platforms were recorded", start, 1.5, *recording);
  const double fps = recording->fps;
  double cutoff = plates.lowpass_hz > 0.0 ? plates.lowpass_hz : 0.4 * fps;
  if (lowpass_hz > 0.0) cutoff = std::min(cutoff, lowpass_hz);
  const bool filtered = cutoff < HighestCutoff(tracks.rate_hz);
  if (filtered) {
    LowPass(cutoff, tracks.rate_hz, &tracks.force);
    LowPass(cutoff, tracks.rate_hz, &tracks.moment);
  }
  person.plates = SampledAt(tracks, start, fps, recording->num_frames(),
                            filtered ? tracks.rate_hz / cutoff : 1.0);
  CheckPlates(tracks.file, *recording, plates.person);
  // With platforms alone the feet are not seen; on ground that moves they go with it.
  if (recording->ground.empty() && !entry.plates_alone) CheckCentre(tracks.file, person);
}

PlateTracks ReadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                       const RecordedPerson& person) {
  const bool of_motion = plates.file.empty();
  const std::string path = of_motion ? person.file : ResolvePath(entry.manifest, plates.file);
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (format == MotionFormat::kBvh || format == MotionFormat::kTrc) {
    throw Error{"a " + Title(*format) +
                    " file holds no force platforms; name the one that does as \"file\" of "
                    "force_plates (C3D, CSV, OpenSim storage)",
                path};
  }
  const bool own_axes = of_motion && plates.up.empty() && plates.forward.empty();
  const Eigen::Matrix3d axes = own_axes ? AxesGiven(person.file_up, person.file_forward)
                                        : AxesGiven(plates.up, plates.forward);
  return (format == MotionFormat::kC3d ? PlatesOfC3d : PlatesOfTable)(path, plates, axes);
}

}  // namespace pushid
