// datasets: platforms read, added up and sampled.
#include "datasets/loading/plate_record.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/sensors/force_platform.h"
#include "datasets/sensors/timed_columns.h"
#include "models/ipm.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

// Evenly sampled, in the project's axes: force, and the moments [F_z p_x, F_z p_y, F_z].
struct PlateTracks {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  int last_line = 0;
  Track force, moment;

  void Add(size_t at, const Eigen::Vector3d& on_person, const Eigen::Vector3d& centre) {
    if (force.size() <= at) {
      force.resize(at + 1, Eigen::Vector3d::Zero());
      moment.resize(at + 1, Eigen::Vector3d::Zero());
    }
    force[at] += on_person;
    if (!centre.allFinite() || on_person.z() <= 0.0) return;
    moment[at] += on_person.z() * Eigen::Vector3d(centre.x(), centre.y(), 1.0);
  }
  double last_s() const { return first_s + (static_cast<double>(force.size()) - 1.0) / rate_hz; }
};

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

Result<PlateTracks> FromC3d(const std::string& path, const ManifestPlates& plates,
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

// Columns of one platform: fx, fy, fz, px, py, pz.
struct PlateColumns {
  int index[6] = {-1, -1, -1, -1, -1, -1};
  // With two coordinates of the centre, whichever of the file's axes are level.
  bool Complete() const {
    const auto there = [](int i) { return i >= 0; };
    return std::all_of(index, index + 3, there) && std::count_if(index + 3, index + 6, there) >= 2;
  }
};

PlateColumns ColumnsOf(const std::string& prefix, const std::vector<std::string>& names) {
  constexpr const char* kEndings[6][2] = {{"fx", "vx"}, {"fy", "vy"}, {"fz", "vz"},
                                          {"px", "px"}, {"py", "py"}, {"pz", "pz"}};
  PlateColumns columns;
  for (int i = 0; i < 6; ++i) {
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

Result<PlateTracks> FromTable(const std::string& path, const ManifestPlates& plates,
                              const Eigen::Matrix3d& axes, int up) {
  std::vector<PlateColumns> all;
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        const std::vector<std::string> wanted =
            plates.plates.empty() ? PrefixesIn(names) : plates.plates;
        std::vector<int> chosen;
        for (const std::string& prefix : wanted) {
          PlateColumns columns = ColumnsOf(prefix, names);
          columns.index[3 + up] = -1;  // the centre's height is not needed, and may be empty
          for (int i = 0; i < 6; ++i) {
            if (columns.index[i] >= 0 || i == 3 + up) continue;
            return Error{"a column of " + (prefix.empty() ? "the platform" : Quoted(prefix)) +
                             " is missing: fx, fy, fz (or vx, vy, vz) and the two of px, py, pz "
                             "that are level are needed; it has " +
                             ListOfNames(names),
                         path};
          }
          all.push_back(columns);
          chosen.insert(chosen.end(), columns.index, columns.index + 6);
        }
        if (all.empty()) {
          return Error{"there are no columns of a force platform (time,fx,fy,fz,px,py); it has " +
                           ListOfNames(names),
                       path};
        }
        return chosen;
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  PlateTracks tracks;
  tracks.file = path;
  tracks.rate_hz = table.rate_hz;
  tracks.first_s = table.first_s;
  tracks.last_line = table.lines.back();
  for (int row = 0; row < table.num_rows(); ++row) {
    for (size_t plate = 0; plate < all.size(); ++plate) {
      Eigen::Matrix<double, 6, 1> value;
      for (int i = 0; i < 6; ++i) {
        const std::vector<double>& column = table.values[6 * plate + i];
        value[i] = column.empty() ? 0.0 : column[row];
      }
      if (!value.head<3>().allFinite()) {
        return Error{"a force of the platform is missing; fill the gap", path, table.lines[row]};
      }
      tracks.Add(row, axes * value.head<3>(), axes * value.tail<3>());
    }
  }
  return tracks;
}

// The file's axis that points up: 0, 1 or 2.
int UpAxis(const Eigen::Matrix3d& axes) {
  Eigen::Index at;
  axes.row(2).cwiseAbs().maxCoeff(&at);
  return static_cast<int>(at);
}

MaybeError CheckWeight(const PlateTracks& tracks, const RecordedPerson& person) {
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
                 tracks.file};
  }
  vertical /= seen;
  const double weight = person.mass_kg * kGravity;
  if (std::abs(vertical / weight - 1.0) <= kWeightTolerance) return std::nullopt;
  return Error{"the mean vertical force is " + Rounded(vertical, 4) + " N, but " +
                   Rounded(person.mass_kg, 4) + " kg weigh " + Rounded(weight, 4) + " N (" +
                   Rounded(100.0 * (vertical / weight - 1.0), 2) +
                   " %): correct mass_kg, the platform's gain or axes, or name the platform under "
                   "the other foot (\"plates\")",
               tracks.file};
}

MaybeError CheckCentre(const PlateTracks& tracks, const RecordedPerson& person) {
  int far = 0, seen = 0;
  double sum = 0.0;
  for (size_t t = 0; t < person.plates.size() && t < person.left_ankle.size(); ++t) {
    if (person.plates[t].weight <= 0.0) continue;
    const Eigen::Vector3d feet = 0.5 * (person.left_ankle[t] + person.right_ankle[t]);
    const double away = (person.plates[t].centre - feet).head<2>().norm();
    far += away > kFarFromFeet;
    sum += away;
    ++seen;
  }
  if (2 * far <= seen) return std::nullopt;
  return Error{"the centre of pressure is " + Rounded(sum / seen, 2) +
                   " m from the ankles on average: platforms and markers must share their origin "
                   "and axes (up, forward), and centres must be in metres",
               tracks.file};
}

}  // namespace

MaybeError LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                      double lowpass_hz, Recording* recording) {
  if (plates.use == PlateUse::kNone) return std::nullopt;
  RecordedPerson& person = recording->people[plates.person];
  const bool of_motion = plates.file.empty();
  const std::string path = of_motion ? person.file : ResolvePath(entry.manifest, plates.file);
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  if (format == MotionFormat::kBvh || format == MotionFormat::kTrc) {
    return Error{std::string("a ") + RowOf(*format).title +
                     " file holds no force platforms; name the one that does as \"file\" of "
                     "force_plates (C3D, CSV, OpenSim storage, Motion-BIDS)",
                 path};
  }
  const bool own_axes = of_motion && plates.up.empty() && plates.forward.empty();
  const std::string up = own_axes ? person.file_up : plates.up.empty() ? "z" : plates.up;
  const std::string forward = own_axes                 ? person.file_forward
                              : plates.forward.empty() ? "x"
                                                       : plates.forward;
  const Eigen::Matrix3d axes = AxesRotation(up, forward).value();
  const bool c3d = format == MotionFormat::kC3d;
  Result<PlateTracks> read =
      c3d ? FromC3d(path, plates, axes) : FromTable(path, plates, axes, UpAxis(axes));
  if (!read.ok()) return read.error();
  PlateTracks& tracks = read.value();
  const double fps = recording->fps, seconds = (recording->num_frames() - 1) / fps;
  const bool same_clock = of_motion || path == person.file;
  const double start =
      plates.start_s.value_or(same_clock && !c3d ? person.file_clock_s : person.skipped_s);
  if (tracks.last_s() < start + seconds - 1.5 / fps || tracks.first_s > start + 0.5 / fps) {
    return Error{"the platforms were recorded from " + Rounded(tracks.first_s, 4) + " to " +
                     Rounded(tracks.last_s(), 4) + " s, the motion from " + Rounded(start, 4) +
                     " to " + Rounded(start + seconds, 4) +
                     " s of that clock; cut the motion (end_frame), or give the right clock at "
                     "frame 0 as \"start\"",
                 path, tracks.last_line};
  }
  double cutoff = plates.lowpass_hz > 0.0 ? plates.lowpass_hz : 0.4 * fps;
  if (lowpass_hz > 0.0) cutoff = std::min(cutoff, lowpass_hz);
  if (cutoff < HighestCutoff(tracks.rate_hz)) {
    LowPass(cutoff, tracks.rate_hz, &tracks.force);
    LowPass(cutoff, tracks.rate_hz, &tracks.moment);
  }
  person.plates.clear();
  for (int t = 0; t < recording->num_frames(); ++t) {
    const double at = (start + t / fps - tracks.first_s) * tracks.rate_hz;
    const Eigen::Vector3d moment = ValueBetween(tracks.moment, at);
    PlateSample sample;
    sample.force = ValueBetween(tracks.force, at);
    if (moment.z() >= kPressed) {
      sample.centre = {moment.x() / moment.z(), moment.y() / moment.z(), 0.0};
      sample.weight = 1.0;
    }
    person.plates.push_back(sample);
  }
  if (MaybeError error = CheckWeight(tracks, person)) return error;
  return recording->ground.empty() ? CheckCentre(tracks, person) : std::nullopt;
}

}  // namespace pushid
