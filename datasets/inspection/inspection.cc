// datasets: what a file holds.
#include "datasets/inspection/inspection.h"

#include <algorithm>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/manifest/joint_choice.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/sensor_choice.h"

namespace pushid {
namespace {

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
  options.length_unit = LengthUnit::kMetre;  // as it stands: the unit is what is to be found
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
  const Result<C3dFile> read = ReadC3d(found->path, {true});
  if (!read.ok()) return read.error();
  const C3dFile& file = read.value();
  found->format += ", " + NameOf(file.processor) + (file.floating ? ", floats" : ", integers");
  if (file.num_frames() < file.announced_frames) {
    found->Warn("the file ends after " + std::to_string(file.num_frames()) + " of " +
                std::to_string(file.announced_frames) +
                " frames: it is truncated and cannot be fitted");
  }
  if (!file.points.empty()) {
    PointReadOptions options;
    options.accept_truncated = true;
    const Result<PointMotion> motion = ReadC3dPoints(found->path, options);
    if (!motion.ok()) return motion.error();
    LookAtPoints(motion.value(), mapping, found);
  }
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
  const Result<std::vector<Eigen::Vector4d>> force = ReadPushCsv(found->path);
  if (!force.ok()) return force.error();
  found->format = "push CSV";
  double peak = 0.0;
  for (const Eigen::Vector4d& row : force.value()) peak = std::max(peak, row.head<2>().norm());
  found->Fact("rows", std::to_string(force.value().size()) + ", one per frame of its recording");
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
  if (const Eigen::Vector3d& rest = record.value().subtracted; rest.norm() > 0.0) {
    found->Fact("at rest", Rounded(record.value().is_vector ? rest.norm() : rest.x(), 3) +
                               " N before the pull, subtracted below and by pushid-push "
                               "(--sensor_zero=0 keeps them)");
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
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
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
  if (first.rfind("frame,fx,fy,ftheta", 0) == 0) return LookAtPush(found);
  if (first == "time,force" || first == "time,fx,fy,fz") return LookAtSensor(found);
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

std::string InspectionText(const Inspection& inspection) {
  std::string text = inspection.path + ": " + inspection.format + "\n";
  for (const auto& [what, said] : inspection.facts) {
    text += "  " + what + std::string(what.size() < 16 ? 16 - what.size() : 1, ' ') + said + "\n";
  }
  for (const std::string& warning : inspection.warnings) text += "  warning: " + warning + "\n";
  return text;
}

}  // namespace pushid
