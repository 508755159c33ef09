// datasets: the manifest read and checked.
#include <cmath>
#include <unordered_map>
#include <utility>

#include "datasets/axes.h"
#include "datasets/bvh.h"
#include "datasets/json_fields.h"
#include "datasets/json_file.h"
#include "datasets/manifest.h"
#include "datasets/number_text.h"
#include "datasets/recording_names.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kHeaviestPerson = 400.0;  // kg

constexpr char kUnits[] = "mm, cm or m";
constexpr int kAnyFrame = 1 << 30;

std::optional<LengthUnit> ReadLengthUnit(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  return fields->Choice(key, &LengthUnitFromName, LengthUnit::kMillimetre, kUnits);
}

std::optional<JointReference> ReadJoint(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  const Json& value = fields->At(key);
  JointReference joint;
  if (value.is_string() && !value.get<std::string>().empty()) {
    joint.name = value.get<std::string>();
  } else if (value.is_number_integer() && value.get<double>() >= 0 &&
             value.get<double>() < kAnyFrame) {
    joint.index = value.get<int>();
  } else {
    fields->Fail(key, "must be a joint's name or its index from 0, not " + Shown(value));
  }
  return joint;
}

void ReadSubjects(const JsonDocument& document, JsonFields* fields, ManifestRecording* recording) {
  if (!fields->Require("subjects", "a list of {\"id\", \"mass_kg\"}")) return;
  int index = 0;
  for (const Json& item : fields->List("subjects")) {
    JsonFields subject(document, item, fields->Pointer("subjects/" + std::to_string(index)),
                       fields->label() + ", subject " + std::to_string(index));
    ManifestSubject read;
    read.id = subject.Text("id", "text that names the person");
    read.mass_kg = subject.Number("mass_kg", "the person's mass in kg");
    if (!subject.error() && !(read.mass_kg > 0.0 && read.mass_kg <= kHeaviestPerson)) {
      subject.Fail("mass_kg", "is " + Rounded(read.mass_kg) +
                                  "; a mass in kg is above 0 and at most " +
                                  Rounded(kHeaviestPerson));
    }
    fields->Fail(subject.error());
    recording->subjects.push_back(read);
    ++index;
  }
  if (index == 0) fields->Fail("subjects", "is empty; name at least one person");
}

void ReadBvhNames(JsonFields* fields, ManifestRecording* recording) {
  if (!fields->Require("bvh", "a list of BVH files, one per subject")) return;
  for (const Json& item : fields->List("bvh")) {
    if (!item.is_string() || item.get<std::string>().empty()) {
      fields->Fail("bvh/" + std::to_string(recording->bvh.size()),
                   "must be a file name, not " + Shown(item));
      return;
    }
    recording->bvh.push_back(item.get<std::string>());
  }
  if (!fields->error() && recording->bvh.size() != recording->subjects.size()) {
    fields->Fail("bvh", "lists " + std::to_string(recording->bvh.size()) + " files for " +
                            std::to_string(recording->subjects.size()) +
                            " subjects; there must be one per subject, in the same order");
  }
}

void ReadPushes(const JsonDocument& document, JsonFields* fields, ManifestRecording* recording) {
  const int people = static_cast<int>(recording->subjects.size());
  for (const Json& item : fields->List("pushes")) {
    const std::string index = std::to_string(recording->pushes.size());
    JsonFields push(document, item, fields->Pointer("pushes/" + index),
                    fields->label() + ", push " + index);
    ManifestPush read;
    read.person = push.Whole("person", "the index of a subject, from 0", 0, people - 1);
    read.csv = push.Text("csv", "the name of a push CSV file");
    if (!push.error() && read.csv.empty()) push.Fail("csv", "is empty");
    if (push.Has("start_frame")) {
      read.start_frame =
          push.Whole("start_frame", "the frame the push starts at, from 0", 0, kAnyFrame);
    }
    if (!push.error() && read.csv == recording->push_csv && read.start_frame == 0 &&
        read.person == recording->pushed_person) {
      push.Fail("csv", "is also given as push_csv; the push would count twice");
    }
    fields->Fail(push.error());
    recording->pushes.push_back(read);
  }
}

Result<ManifestRecording> ReadRecording(const JsonDocument& document, const Json& object,
                                        int index) {
  const std::string pointer = "/recordings/" + std::to_string(index);
  JsonFields fields(document, object, pointer, "recording " + std::to_string(index));
  ManifestRecording recording;
  recording.id = fields.Text("id", "text that names the recording");
  if (!fields.error() && recording.id.empty()) fields.Fail("id", "is empty");
  if (!fields.error()) fields.set_label("recording " + Quoted(recording.id));

  recording.setting = fields.Text("setting", "text, for instance single");
  recording.fps = fields.Number("fps", "the frames per second");
  if (!fields.error() &&
      !(recording.fps >= kMinFramesPerSecond && recording.fps <= kMaxFramesPerSecond)) {
    fields.Fail("fps", "is " + Rounded(recording.fps) + "; accepted are " +
                           Rounded(kMinFramesPerSecond) + " to " + Rounded(kMaxFramesPerSecond) +
                           " frames per second");
  }
  ReadSubjects(document, &fields, &recording);
  if (!fields.error()) {
    const int people = static_cast<int>(recording.subjects.size());
    const std::string what =
        "the index of the pushed subject, " +
        (people == 1 ? std::string("0") : "0 to " + std::to_string(people - 1));
    recording.pushed_person = fields.Whole("pushed_person", what.c_str(), 0, people - 1);
  }
  ReadBvhNames(&fields, &recording);
  recording.push_csv = fields.OptionalText("push_csv", "");
  recording.push_kind = fields.Choice("push_kind", &PushKindFromName, PushKind::kExternal,
                                      "net, net_without_friction or external");
  recording.magnitude =
      fields.Text("magnitude", "the push's strength as a label, for instance weak, medium, strong");
  recording.condition_code = fields.OptionalText("condition_code", "");
  if (fields.Has("joints")) {
    JsonFields joints(document, fields.At("joints"), fields.Pointer("joints"),
                      fields.label() + ", joints");
    recording.joints.hip = ReadJoint(&joints, "hip");
    recording.joints.left_ankle = ReadJoint(&joints, "left_ankle");
    recording.joints.right_ankle = ReadJoint(&joints, "right_ankle");
    fields.Fail(joints.error());
  }
  recording.up = fields.OptionalText("up", recording.up);
  recording.forward = fields.OptionalText("forward", recording.forward);
  const Result<Eigen::Matrix3d> axes = AxesRotation(recording.up, recording.forward);
  if (!axes.ok())
    fields.Fail(document.ErrorAt(fields.Pointer(fields.Has("up") ? "up" : "forward"),
                                 fields.label() + ": " + axes.error().message));
  recording.length_unit = ReadLengthUnit(&fields, "length_unit");
  if (!fields.error()) ReadPushes(document, &fields, &recording);
  recording.initial_velocity = fields.Choice("initial_velocity", &InitialVelocityFromName,
                                             InitialVelocity::kZero, "zero, estimated or free");
  if (fields.Has("frames")) {
    recording.frames = fields.Whole("frames", "the number of frames", 0, kAnyFrame);
  }
  if (fields.error()) return *fields.error();
  recording.json = object;
  return recording;
}

}  // namespace

Result<Manifest> ReadManifest(const std::string& path) {
  Result<JsonDocument> read = ReadJsonDocument(path);
  if (!read.ok()) return read.error();
  const JsonDocument& document = read.value();
  JsonFields top(document, document.content, "", "manifest");
  Manifest manifest;
  manifest.path = path;
  top.Require("recordings", "a list of recordings");
  const Json& recordings = top.List("recordings");
  if (!top.error() && recordings.empty()) {
    top.Fail("recordings", "is empty: the manifest lists no recordings");
  }
  if (top.Has("units") && top.At("units").is_object()) {
    JsonFields units(document, top.At("units"), "/units", "manifest, units");
    manifest.length_unit = ReadLengthUnit(&units, "bvh_length");
    top.Fail(units.error());
  }
  if (top.Has("length_unit")) manifest.length_unit = ReadLengthUnit(&top, "length_unit");
  if (top.error()) return *top.error();

  const std::vector<int> lines = document.ElementLines("/recordings");
  std::unordered_map<std::string, int> line_of_id;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    Result<ManifestRecording> recording =
        ReadRecording(document, recordings[i], static_cast<int>(i));
    if (!recording.ok()) return recording.error();
    recording.value().line = lines[i];
    const auto [earlier, is_new] = line_of_id.emplace(recording.value().id, recording.value().line);
    if (!is_new) {
      return document.ErrorAt("/recordings/" + std::to_string(i) + "/id",
                              "recording " + Quoted(recording.value().id) +
                                  ": this id was given before, in line " +
                                  std::to_string(earlier->second) + "; ids must be unique");
    }
    manifest.recordings.push_back(std::move(recording.value()));
  }
  manifest.json = document.content;
  manifest.json.erase("recordings");
  return manifest;
}

}  // namespace pushid
