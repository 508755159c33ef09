// datasets: the manifest read and checked.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "datasets/files/json_fields.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/laboratory_keys.h"
#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kAnyFrame = 1 << 30;

// Numbers and texts under keys that no program knows.
PersonFacts FactsOf(const Json& object, const JsonFields& fields) {
  PersonFacts facts;
  if (!object.is_object()) return facts;
  const std::vector<std::string>& asked = fields.asked();
  for (const auto& [key, value] : object.items()) {
    if (std::find(asked.begin(), asked.end(), key) != asked.end()) continue;
    if (value.is_number()) facts.numbers[key] = value.get<double>();
    if (value.is_string()) facts.texts[key] = value.get<std::string>();
  }
  return facts;
}

void ReadSubjects(const JsonDocument& document, JsonFields* fields, ManifestRecording* recording) {
  if (!fields->Require("subjects", "a list of {\"id\", \"mass_kg\"}")) return;
  int index = 0;
  for (const Json& item : fields->List("subjects")) {
    JsonFields subject(document, item, fields->Pointer("subjects/" + std::to_string(index)),
                       fields->label() + ", subject " + std::to_string(index));
    ManifestSubject read{subject.Text("id", "text that names the person"),
                         subject.Number("mass_kg", "the person's mass in kg")};
    if (!subject.failed() && !(read.mass_kg > 0.0 && read.mass_kg <= kHeaviestPerson)) {
      subject.Fail("mass_kg", "is " + Rounded(read.mass_kg) +
                                  "; a mass in kg is above 0 and at most " +
                                  Rounded(kHeaviestPerson));
    }
    if (recording->plates_alone) {
      read.rod_m = subject.Number("rod_m", "the distance between ankles and hips in m");
      read.ankle_height_m =
          subject.OptionalNumber("ankle_height_m", "the ankles' height in m", kUsualAnkleHeight);
    }
    read.joints = ReadJointMapping(document, &subject);
    read.known = FactsOf(item, subject);
    fields->Add(subject);
    recording->subjects.push_back(read);
    ++index;
  }
  if (index == 0) fields->Fail("subjects", "is empty; name at least one person");
}

void ReadMotionNames(JsonFields* fields, ManifestRecording* recording) {
  if (recording->plates_alone) return;
  std::string key;
  for (const MotionFormatRow& row : kMotionFormats) {
    if (!fields->Has(row.name)) continue;
    if (!key.empty()) {
      fields->Fail(row.name, "is given together with " + key + "; the motion is in one of them");
    }
    key = row.name;
    recording->motion_format = row.value;
  }
  if (key.empty()) {
    fields->Require(kMotionFormats[0].name,
                    "a list of motion files, one per subject, under the "
                    "key of their format: " +
                        MotionKeys());
    return;
  }
  std::vector<std::string>& files = recording->motion;
  for (const Json& item : fields->List(key.c_str())) {
    if (!item.is_string() || item.get<std::string>().empty()) {
      fields->Fail(key + "/" + std::to_string(files.size()),
                   "must be a file name, not " + Shown(item));
      return;
    }
    files.push_back(item.get<std::string>());
  }
  if (!fields->failed() && files.size() != recording->subjects.size()) {
    fields->Fail(key, "lists " + std::to_string(files.size()) + " files for " +
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
    ManifestPush read{push.Whole("person", "the index of a subject, from 0", 0, people - 1),
                      push.Text("csv", "the name of a push CSV file")};
    if (!push.failed() && read.csv.empty()) push.Fail("csv", "is empty");
    read.start_frame =
        push.OptionalWhole("start_frame", "the frame the push starts at, from 0", 0, kAnyFrame, 0);
    if (!push.failed() && read.csv == recording->push_csv && read.start_frame == 0 &&
        read.person == recording->pushed_person) {
      push.Fail("csv", "is also given as push_csv; the push would count twice");
    }
    fields->Add(push);
    recording->pushes.push_back(read);
  }
}

// A label of published recordings, which is like the key of a format.
constexpr char kSplitLabel[] = "split";

// A text under a key that no program knows is a label as well.
void AddLabels(const Json& object, const JsonFields& fields, RecordingLabels* labels) {
  if (!object.is_object()) return;
  const std::vector<std::string>& known = fields.asked();
  for (const auto& [key, value] : object.items()) {
    const bool used = std::find(known.begin(), known.end(), key) != known.end();
    if (!used && value.is_string()) labels->Set(key, value.get<std::string>());
  }
}

// of: the object's. stated: the errors that the manifest states for all.
ManifestRecording ReadRecording(const JsonDocument& document, const Json& object,
                                const StatedErrors& stated, JsonFields* of) {
  JsonFields& fields = *of;
  ManifestRecording recording;
  recording.id = fields.Text("id", "text that names the recording");
  if (!fields.failed() && recording.id.empty()) fields.Fail("id", "is empty");
  if (!fields.failed()) fields.set_label("recording " + Quoted(recording.id));
  if (!fields.failed() && recording.id.find(',') != std::string::npos) {
    fields.Fail("id", "must have no comma: commas separate ids in lists");
  }

  recording.labels.Set(kSettingLabel, fields.Text(kSettingLabel, "text, for instance single"));
  recording.labels.Set(kMagnitudeLabel, fields.OptionalText(kMagnitudeLabel, ""));
  recording.labels.Set(
      kConditionLabel,
      fields.OptionalText(kConditionLabel, fields.OptionalText(kOldConditionKey, "")));
  if (fields.Has("fps")) {
    recording.fps = fields.Number("fps", "the frames per second");
    const std::string problem = FrameRateProblem(recording.fps);
    if (!problem.empty()) fields.Fail("fps", problem);
  }
  recording.plates_alone = ReadPlatesAlone(&fields);
  ReadSubjects(document, &fields, &recording);
  const int people = static_cast<int>(recording.subjects.size());
  recording.pushed_person =
      fields.Whole("pushed_person",
                   "the index of the pushed subject, " +
                       (people > 1 ? "0 to " + std::to_string(people - 1) : std::string("0")),
                   0, people - 1);
  ReadMotionNames(&fields, &recording);
  recording.mapping = fields.OptionalText("mapping", "");
  recording.push_csv = fields.OptionalText("push_csv", "");
  recording.push_kind = fields.Choice("push_kind", PushKind::kExternal);
  recording.joints = ReadJointMapping(document, &fields);
  recording.up = fields.OptionalText("up", recording.up);
  recording.forward = fields.OptionalText("forward", recording.forward);
  const Result<Eigen::Matrix3d> axes = AxesRotation(recording.up, recording.forward);
  if (!axes.ok())
    fields.Fail(document.ErrorAt(fields.Pointer(fields.Has("up") ? "up" : "forward"),
                                 fields.label() + ": " + axes.error().message));
  recording.length_unit = ReadLengthUnit(&fields, "length_unit");
  recording.length_scale = ReadLengthScale(&fields);
  ReadPushes(document, &fields, &recording);
  recording.initial_velocity = fields.Choice("initial_velocity", InitialVelocity::kZero);
  recording.ground = ReadGroundKey(document, &fields);
  recording.plates = ReadPlatesKey(document, &fields, people);
  CheckPlatesAlone(recording, &fields);
  recording.stated_errors = ReadStatedErrors(document, &fields, stated);
  if (fields.Has("frames")) {
    recording.frames = fields.Whole("frames", "the number of frames", 0, kAnyFrame);
  }
  recording.first_frame =
      fields.OptionalWhole("first_frame", "the file's frame that becomes frame 0", 0, kAnyFrame, 0);
  if (fields.Has("end_frame")) {
    recording.end_frame =
        fields.Whole("end_frame", "the frame after the last one used, after first_frame",
                     recording.first_frame + 1, kAnyFrame);
  }
  AddLabels(object, fields, &recording.labels);
  recording.json = object;
  return recording;
}

}  // namespace

// Those that the reader asks for, here of a recording that has none of them.
const std::vector<std::string>& ManifestKeys() {
  static const std::vector<std::string> keys = [] {
    JsonDocument empty;
    empty.content = Json::object();
    JsonFields fields(empty, empty.content, "", "");
    ReadRecording(empty, empty.content, {}, &fields);
    std::vector<std::string> asked = fields.asked();
    asked.push_back(kSplitLabel);
    return asked;
  }();
  return keys;
}

std::vector<std::string> MisspeltKeys(const ManifestRecording& entry) {
  std::vector<std::string> found;
  if (!entry.json->is_object()) return found;
  for (const auto& [key, value] : entry.json->items()) {
    if (MeantBy(key, ManifestKeys()).empty()) continue;
    found.push_back("has the key " + Quoted(key) + ", which is not known and not used" +
                    MeantText(key, ManifestKeys()));
  }
  return found;
}

Result<Manifest> ReadManifest(const std::string& path) {
  Result<JsonDocument> read = ReadJsonDocument(path);
  if (!read.ok()) return read.error();
  const JsonDocument& document = read.value();
  JsonFields top(document, document.content, "", "manifest");
  Manifest manifest;
  manifest.path = path;
  if (top.Has("format") && !top.Has("recordings")) {
    return document.ErrorAt("/format", "this is a " + top.OptionalText("format", "file") +
                                           ", no manifest of recordings");
  }
  top.Require("recordings", "a list of recordings");
  const Json& recordings = top.List("recordings");
  if (!top.failed() && recordings.empty()) {
    top.Fail("recordings", "is empty: the manifest lists no recordings");
  }
  if (top.Has("units") && top.At("units").is_object()) {
    JsonFields units(document, top.At("units"), "/units", "manifest, units");
    manifest.length_unit = ReadLengthUnit(&units, "bvh_length");
    top.Fail(units.error());
  }
  if (top.Has("length_unit")) manifest.length_unit = ReadLengthUnit(&top, "length_unit");
  manifest.length_scale = ReadLengthScale(&top);
  if (manifest.length_scale && manifest.length_unit && !top.failed()) {
    top.Fail("length_scale", "is given together with units.bvh_length; give one of them");
  }
  manifest.stated_errors = ReadStatedErrors(document, &top, {});
  if (top.error()) return *top.error();

  const std::vector<int> lines = document.ElementLines("/recordings");
  std::unordered_map<std::string, int> line_of_id;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    JsonFields fields(document, recordings[i], "/recordings/" + std::to_string(i),
                      "recording " + std::to_string(i));
    ManifestRecording recording =
        ReadRecording(document, recordings[i], manifest.stated_errors, &fields);
    top.Add(fields);
    if (top.is_wrong()) return *top.error();
    recording.manifest = path;
    recording.line = lines[i];
    const auto [earlier, is_new] = line_of_id.emplace(recording.id, recording.line);
    if (!is_new && !top.failed()) {
      return document.ErrorAt("/recordings/" + std::to_string(i) + "/id",
                              "recording " + Quoted(recording.id) +
                                  ": this id was given before, in line " +
                                  std::to_string(earlier->second) + "; ids must be unique");
    }
    manifest.recordings.push_back(std::move(recording));
  }
  if (top.failed()) return *top.error();
  manifest.json = document.content;
  manifest.json->erase("recordings");
  return manifest;
}

}  // namespace pushid
