// datasets: what a file holds.
#include "datasets/inspection/inspection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/trajectories.h"
#include "datasets/inspection/findings.h"
#include "datasets/inspection/inspect_motion.h"
#include "datasets/loading/laboratory_record.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/force_sensors.h"
#include "models/ipm.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInMillimetres = 1000.0, kDegrees = 180.0 / M_PI;

InspectedGround GroundOf(const ManifestRecording& entry, const Recording& recording) {
  InspectedGround ground;
  ground.recording = entry.id;
  ground.kind = entry.ground.csv.empty() ? "markers" : NameOf(entry.ground.quantity);
  ground.rate_hz = recording.fps;
  if (!entry.ground.csv.empty()) {
    const Result<GroundTracks> tracks = GroundOfCsv(entry);
    if (tracks.ok()) ground.rate_hz = tracks.value().rate_hz;
  }
  const std::vector<GroundPose>& poses = recording.ground;
  for (size_t t = 0; t < poses.size(); ++t) {
    ground.farthest_m = std::max(ground.farthest_m, poses[t].head<2>().norm());
    ground.peak_tilt_rad = std::max(ground.peak_tilt_rad, poses[t].tail<2>().norm());
    if (t == 0 || t + 1 == poses.size()) continue;
    const GroundPose second = poses[t + 1] - 2.0 * poses[t] + poses[t - 1];
    ground.peak_acceleration =
        std::max(ground.peak_acceleration, second.head<2>().norm() * recording.fps * recording.fps);
  }
  return ground;
}

InspectedPlates PlatesOf(const ManifestRecording& entry, const ManifestPlates& plates,
                         const RecordedPerson& person) {
  InspectedPlates found{entry.id, person.subject_id, NameOf(plates.use)};
  const Result<PlateTracks> tracks = ReadPlates(entry, plates, person);
  if (tracks.ok()) {
    found.platforms = tracks.value().platforms;
    found.rate_hz = tracks.value().rate_hz;
  }
  double vertical = 0.0;
  int pressed = 0;
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    const Eigen::Vector2d centre = sample.centre.head<2>();
    found.least = pressed == 0 ? centre : Eigen::Vector2d(found.least.cwiseMin(centre));
    found.most = pressed == 0 ? centre : Eigen::Vector2d(found.most.cwiseMax(centre));
    vertical += sample.force.z();
    ++pressed;
  }
  if (pressed > 0) found.weight_ratio = vertical / pressed / (person.mass_kg * kGravity);
  return found;
}

std::string Span(double least, double most) {
  return Rounded(kInMillimetres * least, 3) + " to " + Rounded(kInMillimetres * most, 3) + " mm";
}

Json Two(const Eigen::Vector2d& v) { return Json::array({v.x(), v.y()}); }

// Ground and platforms of a recording as it was read from its entry, with a fact for each.
void InspectLaboratory(const ManifestRecording& entry, const Recording& recording,
                       Inspection* found) {
  if (entry.ground.given()) {
    const InspectedGround ground = GroundOf(entry, recording);
    found->Fact("ground", entry.id + ": " + ground.kind + " at " + Rounded(ground.rate_hz, 5) +
                              " per second, up to " +
                              Rounded(kInMillimetres * ground.farthest_m, 3) + " mm, " +
                              Rounded(ground.peak_acceleration, 3) + " m/s^2 and " +
                              Rounded(kDegrees * ground.peak_tilt_rad, 3) + " degrees of tilt");
    found->grounds.push_back(ground);
  }
  for (const ManifestPlates& plates : entry.plates) {
    const InspectedPlates seen =
        PlatesOf(entry, plates, recording.people[static_cast<size_t>(plates.person)]);
    std::string text = entry.id + ", " + seen.person + ": " + std::to_string(seen.platforms) +
                       " at " + Rounded(seen.rate_hz, 5) + " per second, ";
    text += plates.use == PlateUse::kNone
                ? "not used"
                : "measured: mean vertical force " + Rounded(seen.weight_ratio, 4) +
                      " of the weight, centre of pressure " + Span(seen.least.x(), seen.most.x()) +
                      " forward and " + Span(seen.least.y(), seen.most.y()) + " to the left";
    found->Fact("force plates", text);
    found->plates.push_back(seen);
  }
}

constexpr std::size_t kMostSignals = 6;  // in the picture
constexpr double kForceOnset = 20.0;     // N
constexpr double kSameMass = 1.05;       // ratio of the masses of one person

// Peak, impulse and onset of a force in N; keeps it for the picture. NaN: no value.
void AddForce(const std::string& name, double rate_hz, std::vector<double> values,
              Inspection* found) {
  double peak = 0.0, impulse = 0.0;
  int onset = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (std::fabs(values[i]) > std::fabs(peak)) peak = values[i];
    impulse += values[i] / rate_hz;
    if (onset < 0 && std::fabs(values[i]) > kForceOnset) onset = static_cast<int>(i);
  }
  found->Fact(name, "peak " + Rounded(peak, 3) + " N, impulse " + Rounded(impulse, 3) + " N s" +
                        (onset >= 0 ? ", above " + Rounded(kForceOnset) + " N from " +
                                          Rounded(onset / rate_hz, 3) + " s"
                                    : ""));
  if (found->forces.size() < kMostSignals) {
    found->forces.push_back({name, "N", rate_hz, std::move(values)});
  }
}

// The analog channels of a C3D file, and what presses its force platforms.
void LookAtAnalog(const C3dFile& file, Inspection* found) {
  std::vector<std::string> names;
  std::set<std::string> units;
  for (const C3dAnalogChannel& channel : file.analog) {
    names.push_back(channel.name);
    units.insert(channel.unit);
    const bool steady =
        std::all_of(channel.samples.begin(), channel.samples.end(),
                    [&channel](double sample) { return sample == channel.samples[0]; });
    if (steady && file.num_frames() > 1) names.back() += " (constant)";
  }
  found->Fact("analog", ListOfNames(names) + " at " + Rounded(file.analog_rate_hz) +
                            " per second, in " + ListOfNames({units.begin(), units.end()}));
  for (const C3dAnalogChannel& channel : file.analog) {
    if (channel.unit == "N" && file.platforms.empty()) {
      AddForce(channel.name, file.analog_rate_hz, channel.samples, found);
    }
  }
}

void LookAtPlatforms(const C3dFile& file, Inspection* found) {
  const std::string up = PointsOfC3d(file).value().up;
  const Eigen::Matrix3d axes =
      AxesRotation(up.empty() ? "z" : up, up.find('x') == std::string::npos ? "x" : "y").value();
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value_or(LengthUnit::kMillimetre);
  for (std::size_t i = 0; i < file.platforms.size(); ++i) {
    const std::string name = "platform:" + std::to_string(i + 1);
    const Result<PlatformRecord> platform = EvaluatePlatform(file, static_cast<int>(i), unit);
    if (!platform.ok()) {
      found->Warn(platform.error().message);
      continue;
    }
    const Eigen::Vector3d& normal = platform.value().normal;
    std::vector<double> pressing;
    for (const Eigen::Vector3d& force : platform.value().force) {
      pressing.push_back(force.dot(normal));
    }
    found->Fact(name + " type", std::to_string(file.platforms[i].type) + ", surface faces (" +
                                    Rounded(normal.x(), 2) + ", " + Rounded(normal.y(), 2) + ", " +
                                    Rounded(normal.z(), 2) + ")");
    AddForce(name, platform.value().rate_hz, std::move(pressing), found);
    for (const std::string& warning : platform.value().warnings) found->Warn(warning);
    if (file.platforms[i].origin.z() > 0.0 && file.platforms[i].type != 1) {
      found->Warn(name + " has its sensors above its surface (ORIGIN z > 0): ORIGIN is negated");
    }
    if (axes.row(2).dot(normal) < -0.5) {
      found->Warn(name +
                  " faces down: is the order of CORNERS (+x, +y), (-x, +y), (-x, -y), (+x, -y)?");
    }
    if (!platform.value().outside.empty()) found->Warn(platform.value().outside);
  }
}

// The file's frame with most people.
std::int64_t FullestFrame(const PointMotion& motion) {
  int fullest = 0;
  std::ptrdiff_t most = -1;
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    const auto there =
        std::count_if(motion.positions.begin(), motion.positions.end(),
                      [frame](const auto& track) { return track[frame].allFinite(); });
    if (there > most) fullest = frame, most = there;
  }
  return FirstFrame(motion) + fullest;
}

// People, times, how close they stand.
void InspectCrowd(const PointMotion& motion, Inspection* found) {
  found->Fact("people", std::to_string(motion.names.size()) + ": " + ListOfNames(motion.names));
  found->Fact("frames", std::to_string(motion.num_frames()) + " at " + Rounded(motion.rate_hz) +
                            " per second, from the file's frame " +
                            std::to_string(FirstFrame(motion)));
  std::vector<std::string> gaps;
  for (std::size_t i = 0; i < motion.positions.size(); ++i) {
    const std::vector<Eigen::Vector3d>& track = motion.positions[i];
    const auto seen = [](const Eigen::Vector3d& place) { return place.allFinite(); };
    const auto first = std::find_if(track.begin(), track.end(), seen);
    const auto end = std::find_if(track.rbegin(), track.rend(), seen).base();
    const auto missing = first < end ? std::count_if(first, end, std::not_fn(seen)) : 0;
    if (missing > 0) gaps.push_back(motion.names[motion.chosen[i]] + " " + std::to_string(missing));
  }
  if (!gaps.empty())
    found->Warn("frames not seen between a person's first and last: " + ListOfNames(gaps));
  const std::int64_t frame = FullestFrame(motion);
  const Result<std::vector<CrowdPlace>> places = PlacesAt(motion, frame);
  if (!places.ok()) return;
  const std::size_t people = places.value().size();
  found->Fact("fullest frame",
              std::to_string(frame) + ": " + std::to_string(people) + " people" +
                  (people < 2 ? ""
                              : ", the nearest other " + Rounded(MedianSpacing(places.value()), 3) +
                                    " m away (median)"));
  const std::string odd = OddSpacing(places.value());
  if (!odd.empty()) found->Warn(odd);
  found->Fact("use",
              "pushid-inspect --wave measures how a push travels; pushid-formation --formation=" +
                  ShellQuoted(motion.path) + " --formation_frame=" + std::to_string(frame) +
                  " places people as they stand there");
}

// Facts about the manifest, and a warning for every recording that cannot be read and everything
// unusual about the others.
MaybeError InspectManifest(Inspection* found) {
  const Result<Manifest> manifest = ReadManifests(found->path);
  if (!manifest.ok()) return manifest.error();
  std::map<std::string, int> settings, formats;
  std::set<std::string> subjects;
  int pushed = 0, read = 0;
  std::vector<PendulumRecording> pendulums;
  std::vector<Finding> facing;
  for (const ManifestRecording& entry : manifest.value().recordings) {
    ++settings[entry.labels.setting()];
    ++formats[entry.plates_alone ? "force plates alone" : Title(entry.motion_format)];
    for (const ManifestSubject& subject : entry.subjects) subjects.insert(subject.id);
    pushed += entry.push_csv.empty() && entry.pushes.empty() ? 0 : 1;
    Warnings warnings;
    LoadOptions options;
    options.plates_alone = true;
    const Result<Recording> recording = LoadRecording(manifest.value(), entry, options, &warnings);
    for (const Warning& warning : warnings) found->Warn(warning.text);
    if (recording.ok()) ++read;
    if (recording.ok()) {
      InspectLaboratory(entry, recording.value(), found);
      pendulums.push_back(MakePendulumRecording(recording.value()));
      const std::vector<Finding> more = FacingFindings(recording.value());
      facing.insert(facing.end(), more.begin(), more.end());
    }
    if (!recording.ok()) found->Warn(recording.error().ToString());
  }
  std::vector<Finding> findings = FindingsOf(pendulums);
  findings.insert(findings.end(), facing.begin(), facing.end());
  for (const std::string& text : FindingTexts(findings)) found->Warn(text);
  for (const std::string& text : MassTexts(pendulums)) found->Warn(text);
  const auto counts = [](const std::map<std::string, int>& of) {
    std::vector<std::string> texts;
    for (const auto& [name, count] : of) texts.push_back(name + " " + std::to_string(count));
    return ListOfNames(texts);
  };
  const std::size_t all = manifest.value().recordings.size();
  found->Fact("recordings", std::to_string(all) + ", " + std::to_string(read) + " can be read, " +
                                std::to_string(pushed) + " have a push");
  found->Fact("settings", counts(settings));
  found->Fact("formats", counts(formats));
  found->Fact("subjects", ListOfNames({subjects.begin(), subjects.end()}));
  return std::nullopt;
}

// A warning where hip and ankles cannot be found.
void LookAtPoints(const PointMotion& motion, const ColumnMapping& mapping, Inspection* found) {
  found->Fact("points", ListOfNames(motion.names));
  const Result<PendulumJoints> joints =
      ChoosePendulumPoints(motion.path, motion.names, mapping.joints);
  if (!joints.ok()) found->Warn(joints.error().message);
  PelvisSides pelvis;
  if (joints.ok()) {
    const Result<BodyRoles> roles =
        ChooseRoles(motion.path, motion.names, nullptr, joints.value(), mapping.joints);
    found->Fact("body", RolesText(roles));
    pelvis = SidesOf(roles);
  }
  InspectMotion(motion, joints.ok() ? std::optional(joints.value()) : std::nullopt, pelvis, found);
}

// A joint of a BVH file is never hidden, so that only hip, its sides and the feet are kept: files
// of a gigabyte fit.
MaybeError LookAtBvh(const ColumnMapping& mapping, Inspection* found) {
  std::optional<PendulumJoints> places;  // indices into the joints kept
  PelvisSides pelvis;
  std::string body;
  std::vector<std::string> names;
  BvhPositionOptions options;
  options.metres_per_unit = 1.0;  // as it stands: the unit is what is to be found
  options.choose_joints = [&](const BvhSkeleton& skeleton) -> Result<std::vector<int>> {
    names = skeleton.Names();
    const Result<PendulumJoints> joints =
        ChoosePendulumJoints(found->path, skeleton, mapping.joints);
    if (!joints.ok()) {
      found->Warn(joints.error().message);
      return std::vector<int>{0};
    }
    const Result<BodyRoles> roles =
        ChooseRoles(found->path, names, &skeleton, joints.value(), mapping.joints);
    body = RolesText(roles);
    pelvis = SidesOf(roles);
    std::vector<int> kept;
    places = joints.value();
    const auto keep = [&kept](std::vector<int>* place) {
      if (place->empty()) return;
      kept.push_back((*place)[0]);
      *place = {static_cast<int>(kept.size()) - 1};
    };
    for (const PendulumTrack& row : kPendulumTracks) keep(&((*places).*row.joints));
    keep(&pelvis.left);
    keep(&pelvis.right);
    return kept;
  };
  Result<BvhPositions> bvh = ReadBvhPositions(found->path, options);
  if (!bvh.ok()) return bvh.error();
  PointMotion motion;
  motion.path = found->path;
  motion.rate_hz = 1.0 / bvh.value().frame_time_s;
  for (int joint : bvh.value().joints) motion.names.push_back(names[joint]);
  ChoosePoints({}, &motion);
  motion.positions = std::move(bvh.value().positions);
  found->Fact("joints", ListOfNames(names));
  if (!body.empty()) found->Fact("body", body);
  InspectMotion(motion, places, pelvis, found);
  return std::nullopt;
}

MaybeError LookAtC3d(const ColumnMapping& mapping, Inspection* found) {
  const Result<C3dFile> read = ReadC3d(found->path, true);
  if (!read.ok()) return read.error();
  const C3dFile& file = read.value();
  found->format += ", " + NameOf(file.processor) + (file.floating ? ", floats" : ", integers");
  if (file.num_frames() < file.announced_frames) {
    found->Warn("the file ends after " + std::to_string(file.num_frames()) + " of " +
                std::to_string(file.announced_frames) +
                " frames: it is truncated and cannot be fitted");
  }
  if (!file.points.empty()) LookAtPoints(PointsOfC3d(file).value(), mapping, found);
  if (!file.analog.empty()) LookAtAnalog(file, found);
  LookAtPlatforms(file, found);
  for (const C3dEvent& event : file.events) {
    found->Fact("event", Rounded(event.time_s, 4) + " s " + event.label +
                             (event.context.empty() ? "" : " (" + event.context + ")"));
  }
  return std::nullopt;
}

MaybeError LookAtCrowd(MotionFormat format, Inspection* found) {
  const Result<PointMotion> motion = ReadPointMotion(found->path, format);
  if (!motion.ok()) return motion.error();
  InspectCrowd(motion.value(), found);
  return std::nullopt;
}

MaybeError LookAtPush(Inspection* found) {
  const Result<PushRows> read = ReadPushCsv(found->path);
  if (!read.ok()) return read.error();
  const std::vector<Eigen::Vector4d>& force = read.value().force;
  found->format = "push CSV";
  double peak = 0.0;
  for (const Eigen::Vector4d& row : force) peak = std::max(peak, row.head<2>().norm());
  found->Fact("rows", std::to_string(force.size()) + ", one per frame of its recording");
  if (!read.value().has_torques) {
    found->Fact("height", "the manifest's push_height_m, or the hip: there are no torques");
  }
  found->Fact("peak", Rounded(peak, 3) + " N");
  return std::nullopt;
}

MaybeError LookAtSensor(Inspection* found) {
  Result<SensorRecord> record = ReadSensorCsv(found->path);
  if (!record.ok()) return record.error();
  found->format = "sensor CSV";
  const std::vector<double>& time = record.value().time_s;
  const double rate = (time.size() - 1) / (time.back() - time.front());
  found->Fact("samples", std::to_string(time.size()) + " at " + Rounded(rate, 5) +
                             " per second, from " + Rounded(time.front()) + " s");
  SubtractRest(&record.value());
  if (const std::string clipped = ClippedText(record.value()); !clipped.empty()) {
    found->Warn(clipped);
  }
  if (const Eigen::Vector3d& rest = record.value().subtracted; rest.norm() > 0.0) {
    found->Fact("at rest", Rounded(record.value().is_vector ? rest.norm() : rest.x(), 3) +
                               " N before the pull, subtracted below and by pushid-push "
                               "(zero: 0, in a list of sensors, keeps them)");
  }
  for (int axis = 0; axis < (record.value().is_vector ? 3 : 1); ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& force : record.value().force) values.push_back(force[axis]);
    AddForce(record.value().is_vector ? std::string("f") + "xyz"[axis] : "force", rate,
             std::move(values), found);
  }
  return std::nullopt;
}

// A table: points where columns come in threes, and forces by their names.
MaybeError LookAtTable(const MotionFormatRow& format, const ColumnMapping& mapping,
                       Inspection* found) {
  const Result<NumericTable> read = ReadNumericTable(found->path, *format.table, {});
  if (!read.ok()) return read.error();
  const NumericTable& table = read.value();
  found->Fact("columns", ListOfNames(table.names));
  const int time = FindTimeColumn(table.names, mapping.time_column);
  double rate = mapping.frame_rate;
  if (time >= 0) {
    const Result<double> step = EvenTimeStep(table, time);
    if (step.ok() && rate == 0.0) rate = 1.0 / step.value();
    if (!step.ok()) found->Warn(step.error().message);
  }
  for (std::size_t i = 0; rate > 0.0 && i < table.names.size(); ++i) {
    if (IsForceColumn(table.names[i])) AddForce(table.names[i], rate, table.data[i], found);
  }
  PointReadOptions options;
  options.columns = mapping.columns;
  options.time_column = mapping.time_column;
  const Result<PointMotion> motion = ReadPointMotion(found->path, format.value, options);
  PointMotion points = motion.ok() ? WithoutForces(motion.value()) : PointMotion();
  points.rate_hz = rate;
  if (motion.ok() && points.names.size() < motion.value().names.size()) {
    found->Fact("of platforms",
                "forces, moments or centres of pressure, which \"force_plates\" of "
                "a manifest reads");
  }
  if (!points.names.empty()) {
    LookAtPoints(points, mapping, found);
  } else {
    found->Fact("rows", std::to_string(table.num_rows()) +
                            (rate > 0.0 ? " at " + Rounded(rate, 5) + " per second" : ""));
    if (!motion.ok() && found->forces.empty()) found->Warn(motion.error().message);
  }
  return std::nullopt;
}

// The first line that says something; empty when there is none.
std::string FirstLine(const std::string& path) {
  LineReader reader;
  std::string_view line;
  if (reader.Open(path) || !reader.NextNonBlank(&line)) return "";
  return std::string(Trimmed(line));
}

MaybeError Look(const ColumnMapping& mapping, Inspection* found) {
  const std::string& path = found->path;
  const std::optional<MotionFormat> format = MotionFormatInFile(path);
  if (!format) {
    const std::string first = FirstLine(path);
    if (!EndsWith(path, ".json") && (first.empty() || first[0] != '{')) {
      return Error{"unknown kind of file: names must end in " + MotionFileEndings() +
                       ", or .json for a manifest",
                   path};
    }
    found->format = "manifest";
    return InspectManifest(found);
  }
  found->format = Title(*format);
  if (HasSkeleton(*format)) return LookAtBvh(mapping, found);
  if (*format == MotionFormat::kC3d) return LookAtC3d(mapping, found);
  if (HoldsCrowd(*format)) return LookAtCrowd(*format, found);
  if (!RowOf(*format).table) {
    const Result<PointMotion> motion = ReadPointMotion(path, *format);
    if (!motion.ok()) return motion.error();
    LookAtPoints(motion.value(), mapping, found);
    return std::nullopt;
  }
  const std::string first = *format == MotionFormat::kCsv ? FirstLine(path) : "";
  std::vector<std::string> names;
  for (std::string_view cell : CellsOf(first, SeparatorOf(first))) names.emplace_back(cell);
  if (IsPush(names)) return LookAtPush(found);
  if (IsSensor(names)) return LookAtSensor(found);
  return LookAtTable(RowOf(*format), mapping, found);
}

}  // namespace

Result<Inspection> Inspect(const std::string& path, const ColumnMapping& mapping) {
  Inspection found;
  found.path = path;
  const std::vector<std::string> paths = ManifestPaths(path);
  for (const std::string& each : paths) {
    InputFile file;  // errors of opening come first
    if (MaybeError failed = file.Open(each)) return *std::move(failed);
    if (paths.size() == 1 || EndsWith(each, ".json")) continue;
    return Error{"commas join manifests (.json) only; separate other files by spaces", each};
  }
  if (paths.size() > 1) {
    found.format = "manifests";
    if (MaybeError failed = InspectManifest(&found)) return *std::move(failed);
    return found;
  }
  if (MaybeError failed = Look(mapping, &found)) return *std::move(failed);
  return found;
}

std::vector<std::string> MassTexts(const std::vector<PendulumRecording>& recordings) {
  std::map<std::string, std::pair<double, double>> masses;  // least and largest, kg
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      const double mass = recording.scene.people[n].body.mass;
      auto& [least, largest] =
          masses.emplace(recording.subject_ids[n], std::pair(mass, mass)).first->second;
      least = std::min(least, mass);
      largest = std::max(largest, mass);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [id, range] : masses) {
    if (range.second <= kSameMass * range.first) continue;
    texts.push_back(id + " weighs " + Rounded(range.first, 3) + " to " + Rounded(range.second, 3) +
                    " kg: one id is one person; correct the masses or the ids");
  }
  return texts;
}

std::string ShellQuoted(const std::string& value) {
  constexpr char kPlain[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%[]";
  if (!value.empty() && value.find_first_not_of(kPlain) == std::string::npos) return value;
  std::string quoted = "'";
  for (const char c : value) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string InspectionText(const Inspection& inspection) {
  std::string text = inspection.path + ": " + inspection.format + "\n";
  for (const auto& [what, said] : inspection.facts) {
    text += "  " + what + std::string(what.size() < 16 ? 16 - what.size() : 1, ' ') + said + "\n";
  }
  for (const std::string& warning : inspection.warnings) text += "  warning: " + warning + "\n";
  return text;
}

Json InspectionJson(const Inspection& inspection) {
  Json json = {
      {"schema", "pushid-inspection/1"}, {"file", inspection.path}, {"format", inspection.format}};
  json["facts"] = Json::array();
  for (const auto& [what, text] : inspection.facts) {
    json["facts"].push_back({{"what", what}, {"text", text}});
  }
  json["warnings"] = inspection.warnings;
  json["ground"] = Json::array();
  for (const InspectedGround& g : inspection.grounds) {
    json["ground"].push_back({{"recording", g.recording},
                              {"kind", g.kind},
                              {"rate_hz", g.rate_hz},
                              {"farthest_m", g.farthest_m},
                              {"peak_acceleration_m_s2", g.peak_acceleration},
                              {"peak_tilt_rad", g.peak_tilt_rad}});
  }
  json["plates"] = Json::array();
  for (const InspectedPlates& p : inspection.plates) {
    json["plates"].push_back({{"recording", p.recording},
                              {"person", p.person},
                              {"use", p.use},
                              {"platforms", p.platforms},
                              {"rate_hz", p.rate_hz},
                              {"weight_ratio", p.weight_ratio},
                              {"centre_least_m", Two(p.least)},
                              {"centre_most_m", Two(p.most)}});
  }
  return json;
}

}  // namespace pushid
