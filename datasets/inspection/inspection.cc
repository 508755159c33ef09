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

std::string Span(double least, double most) {
  return Rounded(kInMillimetres * least, 3) + " to " + Rounded(kInMillimetres * most, 3) + " mm";
}

// How the ground of a recording moved: in its file, and at the frames.
void InspectGround(const ManifestRecording& entry, const Recording& recording, Inspection* found) {
  const auto tracks = Caught([&] { return GroundOfCsv(entry); });
  if (!tracks.ok()) return found->Warn(tracks.error().ToString());
  const std::string kind = NameOf(entry.ground.quantity);
  const double fps = recording.fps, rate = tracks.value().rate_hz;
  double farthest = 0.0, acceleration = 0.0, tilt = 0.0;
  const std::vector<GroundPose>& poses = recording.ground;
  for (size_t t = 0; t < poses.size(); ++t) {
    farthest = std::max(farthest, poses[t].head<2>().norm());
    tilt = std::max(tilt, poses[t].tail<2>().norm());
    if (t == 0 || t + 1 == poses.size()) continue;
    const GroundPose second = poses[t + 1] - 2.0 * poses[t] + poses[t - 1];
    acceleration = std::max(acceleration, second.head<2>().norm() * fps * fps);
  }
  found->Fact("ground", entry.id + ": " + kind + " at " + Rounded(rate, 5) + " per second, up to " +
                            Rounded(kInMillimetres * farthest, 3) + " mm, " +
                            Rounded(acceleration, 3) + " m/s^2 and " + Rounded(kDegrees * tilt, 3) +
                            " degrees of tilt");
  found->ground.push_back({{"recording", entry.id},
                           {"kind", kind},
                           {"rate_hz", rate},
                           {"farthest_m", farthest},
                           {"peak_acceleration_m_s2", acceleration},
                           {"peak_tilt_rad", tilt}});
}

// The platforms under a person: their file, and where and how much they are pressed at the frames.
void InspectPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                   const RecordedPerson& person, Inspection* found) {
  int platforms = 0, pressed = 0;
  double rate = 0.0, vertical = 0.0;
  // Platforms that are not used may be in a file that cannot be read.
  const auto tracks = Caught([&] { return ReadPlates(entry, plates, person); });
  if (tracks.ok()) platforms = tracks.value().platforms, rate = tracks.value().rate_hz;
  Eigen::Vector2d least(0.0, 0.0), most(0.0, 0.0);  // of the centre of pressure
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    const Eigen::Vector2d centre = sample.centre.head<2>();
    least = pressed == 0 ? centre : Eigen::Vector2d(least.cwiseMin(centre));
    most = pressed == 0 ? centre : Eigen::Vector2d(most.cwiseMax(centre));
    vertical += sample.force.z();
    ++pressed;
  }
  const double ratio = pressed > 0 ? vertical / pressed / (person.mass_kg * kGravity) : 0.0;
  found->Fact("force plates",
              StrCat(entry.id, ", ", person.subject_id, ": ", platforms, " at ", Rounded(rate, 5),
                     " per second, ",
                     plates.use == PlateUse::kNone
                         ? "not used"
                         : "measured: mean vertical force " + Rounded(ratio, 4) +
                               " of the weight, centre of pressure " + Span(least.x(), most.x()) +
                               " forward and " + Span(least.y(), most.y()) + " to the left"));
  found->plates.push_back({{"recording", entry.id},
                           {"person", person.subject_id},
                           {"use", NameOf(plates.use)},
                           {"platforms", platforms},
                           {"rate_hz", rate},
                           {"weight_ratio", ratio},
                           {"centre_least_m", {least.x(), least.y()}},
                           {"centre_most_m", {most.x(), most.y()}}});
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
    found->forces.push_back({name, rate_hz, std::move(values)});
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
    const std::optional<double> newtons = NewtonsIn(channel.unit);
    if (!newtons || !file.platforms.empty()) continue;
    std::vector<double> force = channel.samples;
    for (double& sample : force) sample *= *newtons;
    AddForce(channel.name, file.analog_rate_hz, std::move(force), found);
  }
}

void LookAtPlatforms(const C3dFile& file, Inspection* found) {
  const std::string up = OrThrow(PointsOfC3d(file)).up;
  const Eigen::Matrix3d axes = AxesGiven(up, up.find('x') == std::string::npos ? "x" : "y");
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value_or(LengthUnit::kMillimetre);
  for (std::size_t i = 0; i < file.platforms.size(); ++i) {
    const std::string name = StrCat("platform:", i + 1);
    const Result<PlatformRecord> evaluated = EvaluatePlatform(file, static_cast<int>(i), unit);
    if (!evaluated.ok()) {
      found->Warn(evaluated.error().message);
      continue;
    }
    const PlatformRecord& platform = evaluated.value();
    const Eigen::Vector3d& normal = platform.normal;
    std::vector<double> pressing;
    for (const Eigen::Vector3d& force : platform.force) pressing.push_back(force.dot(normal));
    found->Fact(name + " type",
                StrCat(file.platforms[i].type, ", surface faces (", Rounded(normal.x(), 2), ", ",
                       Rounded(normal.y(), 2), ", ", Rounded(normal.z(), 2), ")"));
    AddForce(name, platform.rate_hz, std::move(pressing), found);
    for (const std::string& warning : platform.warnings) found->Warn(warning);
    if (file.platforms[i].origin.z() > 0.0 && file.platforms[i].type != 1) {
      found->Warn(name + " has its sensors above its surface (ORIGIN z > 0): ORIGIN is negated");
    }
    if (axes.row(2).dot(normal) < -0.5) {
      found->Warn(name +
                  " faces down: is the order of CORNERS (+x, +y), (-x, +y), (-x, -y), (+x, -y)?");
    }
    if (!platform.outside.empty()) found->Warn(platform.outside);
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
  found->Fact("people", StrCat(motion.names.size(), ": ", ListOfNames(motion.names)));
  found->Fact("frames", StrCat(motion.num_frames(), " at ", Rounded(motion.rate_hz),
                               " per second, from the file's frame ", FirstFrame(motion)));
  std::vector<std::string> gaps;
  for (std::size_t i = 0; i < motion.positions.size(); ++i) {
    const std::vector<Eigen::Vector3d>& track = motion.positions[i];
    const auto seen = [](const Eigen::Vector3d& place) { return place.allFinite(); };
    const auto first = std::find_if(track.begin(), track.end(), seen);
    const auto end = std::find_if(track.rbegin(), track.rend(), seen).base();
    const auto missing = first < end ? std::count_if(first, end, std::not_fn(seen)) : 0;
    if (missing > 0) gaps.push_back(StrCat(motion.names[motion.chosen[i]], " ", missing));
  }
  if (!gaps.empty()) {
    found->Warn("frames not seen between a person's first and last: " + ListOfNames(gaps));
  }
  const std::int64_t frame = FullestFrame(motion);
  const Result<std::vector<CrowdPlace>> places = PlacesAt(motion, frame);
  if (!places.ok()) return;
  const std::size_t people = places.value().size();
  found->Fact("fullest frame", StrCat(frame, ": ", people, " people",
                                      people < 2 ? ""
                                                 : ", the nearest other " +
                                                       Rounded(MedianSpacing(places.value()), 3) +
                                                       " m away (median)"));
  const std::string odd = OddSpacing(places.value());
  if (!odd.empty()) found->Warn(odd);
  found->Fact(
      "use",
      StrCat("pushid-inspect --wave measures how a push travels; pushid-formation --formation=",
             ShellQuoted(motion.path), " --formation_frame=", frame,
             " places people as they stand there"));
}

// Facts about the manifest, and a warning for every recording that cannot be read and everything
// unusual about the others.
void InspectManifest(Inspection* found) {
  const Manifest manifest = OrThrow(ReadManifests(found->path));
  std::map<std::string, int> settings, formats;
  std::set<std::string> subjects;
  int pushed = 0;
  std::vector<PendulumRecording> pendulums;
  std::vector<Finding> facing;
  for (const ManifestRecording& entry : manifest.recordings) {
    ++settings[entry.labels.setting()];
    ++formats[entry.plates_alone ? "force plates alone" : Title(entry.motion_format)];
    for (const ManifestSubject& subject : entry.subjects) subjects.insert(subject.id);
    pushed += entry.push_csv.empty() && entry.pushes.empty() ? 0 : 1;
    Warnings warnings;
    LoadOptions options;
    options.plates_alone = true;
    const Result<Recording> read = LoadRecording(manifest, entry, options, &warnings);
    for (const Warning& warning : warnings) found->Warn(warning.text);
    if (!read.ok()) {
      found->Warn(read.error().ToString());
      continue;
    }
    const Recording& recording = read.value();
    if (entry.ground.given()) InspectGround(entry, recording, found);
    for (const ManifestPlates& plates : entry.plates) {
      InspectPlates(entry, plates, recording.people[plates.person], found);
    }
    pendulums.push_back(MakePendulumRecording(recording));
    const std::vector<Finding> more = FacingFindings(recording);
    facing.insert(facing.end(), more.begin(), more.end());
  }
  std::vector<Finding> findings = FindingsOf(pendulums);
  findings.insert(findings.end(), facing.begin(), facing.end());
  for (const std::string& text : FindingTexts(findings)) found->Warn(text);
  for (const std::string& text : MassTexts(pendulums)) found->Warn(text);
  const auto counts = [](const std::map<std::string, int>& of) {
    std::vector<std::string> texts;
    for (const auto& [name, count] : of) texts.push_back(StrCat(name, " ", count));
    return ListOfNames(texts);
  };
  found->Fact("recordings", StrCat(manifest.recordings.size(), ", ", pendulums.size(),
                                   " can be read, ", pushed, " have a push"));
  found->Fact("settings", counts(settings));
  found->Fact("formats", counts(formats));
  found->Fact("subjects", ListOfNames({subjects.begin(), subjects.end()}));
}

// Hip, ankles, feet and pelvis of a motion, as indices into its names.
struct FoundPlaces {
  std::optional<PendulumJoints> joints;
  PelvisSides pelvis;
  std::string body;
};

// Warns where hip and ankles cannot be found.
FoundPlaces PlacesOf(const PointMotion& motion, const ColumnMapping& mapping, Inspection* found) {
  const BvhSkeleton* skeleton = motion.skeleton.get();
  const auto joints = ChoosePendulum(motion.path, motion.names, skeleton, mapping.joints);
  if (!joints.ok()) {
    found->Warn(joints.error().message);
    return {};
  }
  const auto roles =
      ChooseRoles(motion.path, motion.names, skeleton, joints.value(), mapping.joints);
  return {joints.value(), SidesOf(roles), RolesText(roles)};
}

void LookAtPoints(const PointMotion& motion, const ColumnMapping& mapping, Inspection* found) {
  found->Fact("points", ListOfNames(motion.names));
  const FoundPlaces places = PlacesOf(motion, mapping, found);
  if (!places.body.empty()) found->Fact("body", places.body);
  InspectMotion(motion, places.joints, places.pelvis, found);
}

// A joint of a BVH file is never hidden, so that only hip, its sides and the feet are kept: files
// of a gigabyte fit.
void LookAtBvh(const ColumnMapping& mapping, Inspection* found) {
  FoundPlaces places;  // indices into the joints kept
  PointReadOptions options;
  options.choose = [&](const PointMotion& file) {
    places = PlacesOf(file, mapping, found);
    std::vector<int> kept;
    const auto keep = [&kept](std::vector<int>* place) {
      if (place->empty()) return;
      kept.push_back((*place)[0]);
      *place = {static_cast<int>(kept.size()) - 1};
    };
    if (!places.joints) return std::vector<int>{0};
    for (const PendulumTrack& row : kPendulumTracks) keep(&((*places.joints).*row.joints));
    keep(&places.pelvis.left);
    keep(&places.pelvis.right);
    return kept;
  };
  PointMotion motion = OrThrow(ReadBvhPoints(found->path, options));
  found->Fact("joints", ListOfNames(motion.names));
  if (!places.body.empty()) found->Fact("body", places.body);
  std::vector<std::string> kept;
  for (int joint : motion.chosen) kept.push_back(motion.names[joint]);
  motion.names = std::move(kept);
  ChoosePoints({}, &motion);
  InspectMotion(motion, places.joints, places.pelvis, found);
}

void LookAtC3d(const ColumnMapping& mapping, Inspection* found) {
  const C3dFile file = OrThrow(ReadC3d(found->path, true));
  found->format += ", " + NameOf(file.processor) + (file.floating ? ", floats" : ", integers");
  if (file.num_frames() < file.announced_frames) {
    found->Warn(StrCat("the file ends after ", file.num_frames(), " of ", file.announced_frames,
                       " frames: it is truncated and cannot be fitted"));
  }
  if (!file.points.empty()) LookAtPoints(OrThrow(PointsOfC3d(file)), mapping, found);
  if (!file.analog.empty()) LookAtAnalog(file, found);
  LookAtPlatforms(file, found);
}

void LookAtPush(Inspection* found) {
  const PushRows push = OrThrow(ReadPushCsv(found->path));
  found->format = "push CSV";
  double peak = 0.0;
  for (const Eigen::Vector4d& row : push.force) peak = std::max(peak, row.head<2>().norm());
  found->Fact("rows", StrCat(push.force.size(), ", one per frame of its recording"));
  if (!push.has_torques) {
    found->Fact("height", "the manifest's push_height_m, or the hip: there are no torques");
  }
  found->Fact("peak", Rounded(peak, 3) + " N");
}

void LookAtSensor(Inspection* found) {
  SensorRecord record = OrThrow(ReadSensorCsv(found->path));
  found->format = "sensor CSV";
  const std::vector<double>& time = record.time_s;
  const double rate = (time.size() - 1) / (time.back() - time.front());
  found->Fact("samples", StrCat(time.size(), " at ", Rounded(rate, 5), " per second, from ",
                                Rounded(time.front()), " s"));
  SubtractRest(&record);
  if (const std::string clipped = ClippedText(record); !clipped.empty()) found->Warn(clipped);
  const bool vector = record.is_vector;
  if (const Eigen::Vector3d& rest = record.subtracted; rest.norm() > 0.0) {
    found->Fact("at rest", Rounded(vector ? rest.norm() : rest.x(), 3) +
                               " N before the pull, subtracted below and by pushid-push "
                               "(zero: 0, in a list of sensors, keeps them)");
  }
  for (int axis = 0; axis < (vector ? 3 : 1); ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& force : record.force) values.push_back(force[axis]);
    AddForce(vector ? StrCat("f", "xyz"[axis]) : "force", rate, std::move(values), found);
  }
}

// A table: points where columns come in threes, and forces by their names.
void LookAtTable(const MotionFormatRow& format, const ColumnMapping& mapping, Inspection* found) {
  const NumericTable table = OrThrow(ReadNumericTable(found->path, *format.table));
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
  if (mapping.length.length_unit) points.unit = mapping.length.length_unit;
  if (motion.ok() && points.names.size() < motion.value().names.size()) {
    found->Fact("of platforms",
                "forces, moments or centres of pressure, which \"force_plates\" of "
                "a manifest reads");
  }
  if (!points.names.empty()) return LookAtPoints(points, mapping, found);
  found->Fact("rows", StrCat(table.num_rows(),
                             rate > 0.0 ? " at " + Rounded(rate, 5) + " per second" : ""));
  if (!motion.ok() && found->forces.empty()) found->Warn(motion.error().message);
}

// The first line that says something; empty when there is none.
std::string FirstLine(const std::string& path) {
  const auto first = Caught([&] {
    LineReader reader(path);
    std::string_view line;
    return std::string(reader.NextNonBlank(&line) ? Trimmed(line) : "");
  });
  return first.ok() ? first.value() : "";
}

void Look(const ColumnMapping& mapping, Inspection* found) {
  const std::string& path = found->path;
  const std::optional<MotionFormat> format = MotionFormatInFile(path);
  if (!format) {
    const std::string first = FirstLine(path);
    if (!EndsWith(path, ".json") && (first.empty() || first[0] != '{')) {
      throw Error{"unknown kind of file: names must end in " + MotionFileEndings() +
                      ", or .json for a manifest",
                  path};
    }
    found->format = "manifest";
    return InspectManifest(found);
  }
  found->format = Title(*format);
  if (HasSkeleton(*format)) return LookAtBvh(mapping, found);
  if (*format == MotionFormat::kC3d) return LookAtC3d(mapping, found);
  if (HoldsCrowd(*format)) return InspectCrowd(OrThrow(ReadPointMotion(path, *format)), found);
  if (!RowOf(*format).table) {
    return LookAtPoints(OrThrow(ReadPointMotion(path, *format)), mapping, found);
  }
  const std::string first = *format == MotionFormat::kCsv ? FirstLine(path) : "";
  std::vector<std::string> names;
  for (std::string_view cell : CellsOf(first, SeparatorOf(first))) names.emplace_back(cell);
  if (IsPush(names)) return LookAtPush(found);
  if (IsSensor(names)) return LookAtSensor(found);
  LookAtTable(RowOf(*format), mapping, found);
}

}  // namespace

Result<Inspection> Inspect(const std::string& path, const ColumnMapping& mapping) {
  return Caught([&] {
    Inspection found;
    found.path = path;
    const std::vector<std::string> paths = ManifestPaths(path);
    for (const std::string& each : paths) {
      InputFile file(each);  // errors of opening come first
      if (paths.size() == 1 || EndsWith(each, ".json")) continue;
      throw Error{"commas join manifests (.json) only; separate other files by spaces", each};
    }
    if (paths.size() > 1) {
      found.format = "manifests";
      InspectManifest(&found);
    } else {
      Look(mapping, &found);
    }
    return found;
  });
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
  json["ground"] = inspection.ground;
  json["plates"] = inspection.plates;
  return json;
}

}  // namespace pushid
