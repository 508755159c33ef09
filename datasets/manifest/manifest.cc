// datasets: manifests read and written, and the recordings that a run takes of them.
#include "datasets/manifest/manifest.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/recording.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kSchema[] = "pushid-manifest/1";
constexpr int kAnyFrame = 1 << 30;
constexpr double kHighestPush = 3.0;  // m

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

void ReadSubjects(JsonFields* fields, ManifestRecording* recording) {
  if (!fields->Require("subjects", "a list of {\"id\", \"mass_kg\"}")) return;
  int index = 0;
  for (const Json& item : fields->List("subjects")) {
    JsonFields subject =
        fields->Inside(item, StrCat("subjects/", index), StrCat("subject ", index));
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
    read.joints = ReadJointMapping(&subject);
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
      fields->Fail(StrCat(key, "/", files.size()), "must be a file name, not " + Shown(item));
      return;
    }
    files.push_back(item.get<std::string>());
  }
  if (!fields->failed() && files.size() != recording->subjects.size()) {
    fields->Fail(key, StrCat("lists ", files.size(), " files for ", recording->subjects.size(),
                             " subjects; there must be one per subject, in the same order"));
  }
}

void ReadPushes(JsonFields* fields, ManifestRecording* recording) {
  const int people = static_cast<int>(recording->subjects.size());
  for (const Json& item : fields->List("pushes")) {
    const std::string index = std::to_string(recording->pushes.size());
    JsonFields push = fields->Inside(item, "pushes/" + index, "push " + index);
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
  recording.fps = fields.OptionalNumber("fps", "the frames per second", 0.0);
  const std::string problem = FrameRateProblem(recording.fps);
  if (fields.Has("fps") && !problem.empty()) fields.Fail("fps", problem);
  recording.plates_alone = ReadPlatesAlone(&fields);
  ReadSubjects(&fields, &recording);
  const int people = static_cast<int>(recording.subjects.size());
  recording.pushed_person =
      fields.Whole("pushed_person",
                   "the index of the pushed subject, " +
                       (people > 1 ? StrCat("0 to ", people - 1) : std::string("0")),
                   0, people - 1);
  ReadMotionNames(&fields, &recording);
  recording.mapping = fields.OptionalText("mapping", "");
  recording.push_csv = fields.OptionalText("push_csv", "");
  recording.push_kind = fields.Choice("push_kind", PushKind::kExternal);
  recording.push_height_m =
      fields.NumberIfAny("push_height_m", "the push's height above the ground");
  const double height = recording.push_height_m.value_or(0.0);
  if (!(height >= 0.0 && height <= kHighestPush)) {
    fields.Fail("push_height_m",
                "is " + Rounded(height) + "; a push is between 0 and 3 m above the ground");
  }
  recording.joints = ReadJointMapping(&fields);
  recording.up = fields.OptionalText("up", recording.up);
  recording.forward = fields.OptionalText("forward", recording.forward);
  const Result<Eigen::Matrix3d> axes = AxesRotation(recording.up, recording.forward);
  if (!axes.ok()) {
    fields.Fail(document.ErrorAt(fields.Pointer(fields.Has("up") ? "up" : "forward"),
                                 fields.label() + ": " + axes.error().message));
  }
  recording.length = ReadLength(&fields);
  ReadPushes(&fields, &recording);
  recording.initial_velocity = fields.Choice("initial_velocity", InitialVelocity::kZero);
  recording.ground = ReadGroundKey(&fields);
  recording.plates = ReadPlatesKey(&fields, people);
  CheckPlatesAlone(recording, &fields);
  recording.stated_errors = ReadStatedErrors(&fields, stated);
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
  // A text under a key that no program knows is a label as well.
  for (const auto& [key, text] : FactsOf(object, fields).texts) recording.labels.Set(key, text);
  recording.json = object;
  return recording;
}

// Sets an optional key: written when it says something or was there already and still may; removed
// when it was emptied.
template <typename T>
void SetUnless(bool is_default, const char* key, const T& value, Json* object) {
  if (!is_default) {
    (*object)[key] = value;
  } else {
    object->erase(key);
  }
}

// Sets a key whose default value may as well be spelled out.
template <typename T>
void SetOrKeep(bool is_default, const char* key, const T& value, Json* object) {
  if (!is_default || object->contains(key)) (*object)[key] = value;
}

Json JointJson(const JointReference& joint) {
  if (!joint.mean_of.empty()) {
    Json list = Json::array();
    for (const JointReference& one : joint.mean_of) list.push_back(JointJson(one));
    return list;
  }
  return joint.name.empty() ? Json(joint.index) : Json(joint.name);
}

// The value under `key` where it is a list of `size` objects, so that their other keys stay;
// otherwise a list of that many empty ones.
Json ObjectsUnder(const Json& object, const char* key, std::size_t size) {
  Json list = object.contains(key) ? object.at(key) : Json();
  const bool usable =
      list.is_array() && list.size() == size &&
      std::all_of(list.begin(), list.end(), [](const Json& item) { return item.is_object(); });
  return usable ? list : Json(size, Json::object());
}

// The pendulum's joints come first, as people write them.
Json JointsJson(const JointMapping& joints, const Json& object) {
  Json json = object.contains("joints") ? object.at("joints") : Json::object();
  std::vector<int> roles = {kBodyHip, kLeftAnkle, kRightAnkle};
  for (int role = 0; role < kBodyJoints; ++role) roles.push_back(role);
  for (int role : roles) {
    const auto joint = joints.of_role.find(role);
    const bool none = joint == joints.of_role.end();
    SetUnless(none, RoleName(role).c_str(), none ? Json() : JointJson(joint->second), &json);
  }
  return json;
}

Json RecordingJson(const ManifestRecording& recording) {
  Json json = recording.json->is_object() ? *recording.json : Json::object();
  json["id"] = recording.id;
  const RecordingLabels& labels = recording.labels;
  json[kSettingLabel] = labels.setting();
  // Left out again where the file says it.
  const bool whole_fps = recording.fps == std::floor(recording.fps) && recording.fps < 1e6;
  SetUnless(recording.fps == 0.0, "fps",
            whole_fps ? Json(static_cast<int>(recording.fps)) : Json(recording.fps), &json);
  Json subjects = ObjectsUnder(json, "subjects", recording.subjects.size());
  for (std::size_t i = 0; i < recording.subjects.size(); ++i) {
    subjects[i]["id"] = recording.subjects[i].id;
    subjects[i]["mass_kg"] = recording.subjects[i].mass_kg;
    // Keys that were read stay as they were spelt.
    const PersonFacts& known = recording.subjects[i].known;
    for (const auto& [key, number] : known.numbers) subjects[i].emplace(key, number);
    for (const auto& [key, text] : known.texts) subjects[i].emplace(key, text);
    const Json joints = JointsJson(recording.subjects[i].joints, subjects[i]);
    SetUnless(joints.empty(), "joints", joints, &subjects[i]);
  }
  json["subjects"] = subjects;
  json["pushed_person"] = recording.pushed_person;
  if (recording.plates_alone) {
    json["motion"] = "none";
  } else {
    json[NameOf(recording.motion_format)] = recording.motion;
  }
  SetUnless(recording.mapping.empty(), "mapping", recording.mapping, &json);
  SetUnless(recording.push_csv.empty(), "push_csv", recording.push_csv, &json);
  json["push_kind"] = NameOf(recording.push_kind);
  SetUnless(!recording.push_height_m, "push_height_m", recording.push_height_m.value_or(0.0),
            &json);
  SetUnless(labels.magnitude().empty(), kMagnitudeLabel, labels.magnitude(), &json);
  // A file that has both keeps both; one that has the old key alone gets the new one.
  if (!json.contains(kConditionLabel)) json.erase(kOldConditionKey);
  SetOrKeep(labels.condition().empty(), kConditionLabel, labels.condition(), &json);
  for (const std::string& key : labels.Keys()) json[key] = labels.Of(key);
  const Json joints = JointsJson(recording.joints, json);
  SetUnless(joints.empty(), "joints", joints, &json);
  SetOrKeep(recording.up == "z", "up", recording.up, &json);
  SetOrKeep(recording.forward == "x", "forward", recording.forward, &json);
  const GivenLength& length = recording.length;
  SetUnless(!length.length_unit, "length_unit",
            length.length_unit ? NameOf(*length.length_unit) : "", &json);
  SetUnless(!length.length_scale, "length_scale", length.length_scale.value_or(0.0), &json);
  Json pushes = ObjectsUnder(json, "pushes", recording.pushes.size());
  for (std::size_t i = 0; i < recording.pushes.size(); ++i) {
    pushes[i]["person"] = recording.pushes[i].person;
    pushes[i]["csv"] = recording.pushes[i].csv;
    pushes[i]["start_frame"] = recording.pushes[i].start_frame;
  }
  SetOrKeep(recording.pushes.empty(), "pushes", pushes, &json);
  SetOrKeep(recording.initial_velocity == InitialVelocity::kZero, "initial_velocity",
            NameOf(recording.initial_velocity), &json);
  SetUnless(!recording.frames, "frames", recording.frames.value_or(0), &json);
  SetOrKeep(recording.first_frame == 0, "first_frame", recording.first_frame, &json);
  SetUnless(!recording.end_frame, "end_frame", recording.end_frame.value_or(0), &json);
  return json;
}

// "group_1 (9), row_1 (13), single (32)"
std::string SettingsOf(const Manifest& manifest) {
  std::map<std::string, int> counts;
  for (const ManifestRecording& recording : manifest.recordings)
    ++counts[recording.labels.setting()];
  std::vector<std::string> texts;
  for (const auto& [setting, count] : counts) {
    texts.push_back(StrCat(setting, " (", count, ")"));
  }
  return ListOfNames(texts);
}

}  // namespace

// The keys that the reader asks for, here in an entry that has none of them.
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

Result<ManifestRecording> WithKey(const ManifestRecording& recording, const std::string& key,
                                  const std::string& value) {
  JsonDocument document;
  document.content = RecordingJson(recording);
  Json* at = &document.content;
  for (const std::string& name : SplitList(key, '.')) {
    if (!at->is_object()) *at = Json::object();
    at = &(*at)[name];
  }
  *at = Json::parse(value, nullptr, false);
  if (at->is_discarded()) *at = value;
  JsonFields fields(document, document.content, "", "recording " + Quoted(recording.id));
  ManifestRecording read = ReadRecording(document, document.content, {}, &fields);
  if (fields.failed()) return *fields.error();
  return read;
}

std::vector<std::string> MisspeltKeys(const ManifestRecording& entry) {
  std::vector<std::string> found;
  if (!entry.json->is_object()) return found;
  for (const auto& [key, value] : entry.json->items()) {
    if (ClosestName(key, ManifestKeys()).empty()) continue;
    found.push_back("has the key " + Quoted(key) + ", which is not known and not used" +
                    Suggestion(key, ManifestKeys()));
  }
  return found;
}

Result<Manifest> ReadManifest(const std::string& path) {
  return Caught([&] {
    const JsonDocument document = OrThrow(ReadJsonDocument(path));
    JsonFields top(document, document.content, "", "manifest");
    Manifest manifest;
    manifest.path = path;
    if (top.Has("format") && !top.Has("recordings")) {
      throw document.ErrorAt("/format", "this is a " + top.OptionalText("format", "file") +
                                            ", no manifest of recordings");
    }
    const std::string schema = top.OptionalText("schema", kSchema);
    if (schema != kSchema && schema.rfind("pushid-manifest/", 0) == 0) {
      throw document.ErrorAt("/schema", Quoted(schema) + " is newer; update pushid to read it");
    }
    top.Require("recordings", "a list of recordings");
    const Json& recordings = top.List("recordings");
    if (!top.failed() && recordings.empty()) {
      top.Fail("recordings", "is empty: the manifest lists no recordings");
    }
    std::optional<LengthUnit> of_units;
    if (top.Has("units") && top.At("units").is_object()) {
      JsonFields units = top.Inside(top.At("units"), "units", "units");
      if (units.Has("bvh_length")) of_units = units.Choice("bvh_length", LengthUnit::kMillimetre);
      top.Fail(units.error());
    }
    manifest.length = ReadLength(&top);
    if (!manifest.length.length_unit) manifest.length.length_unit = of_units;
    if (manifest.length.length_scale && of_units && !top.failed()) {
      top.Fail("length_scale", "is given together with units.bvh_length; give one of them");
    }
    const StatedErrors stated = ReadStatedErrors(&top, {});
    OrThrow(top.error());

    const std::vector<int> lines = document.ElementLines("/recordings");
    std::unordered_map<std::string, int> line_of_id;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
      const std::string place = StrCat("/recordings/", i);
      JsonFields fields(document, recordings[i], place, StrCat("recording ", i));
      ManifestRecording recording = ReadRecording(document, recordings[i], stated, &fields);
      top.Add(fields);
      if (top.is_wrong()) throw *top.error();
      recording.manifest = path;
      recording.line = lines[i];
      const auto [earlier, is_new] = line_of_id.emplace(recording.id, recording.line);
      if (!is_new && !top.failed()) {
        throw document.ErrorAt(place + "/id", StrCat("recording ", Quoted(recording.id),
                                                     ": this id was given before, in line ",
                                                     earlier->second, "; ids must be unique"));
      }
      manifest.recordings.push_back(std::move(recording));
    }
    OrThrow(top.error());
    manifest.json = document.content;
    manifest.json->erase("recordings");
    return manifest;
  });
}

ManifestRecording EntryOf(const Recording& recording) {
  ManifestRecording entry;
  entry.SetFacts(recording);
  entry.fps = recording.fps;
  entry.frames = recording.num_frames();
  return entry;
}

MaybeError WriteManifest(const std::string& path, const Manifest& manifest) {
  Json json = Json::object();
  if (manifest.path.empty()) json["schema"] = kSchema;  // what was read stays as it was
  if (manifest.json->is_object()) json.update(*manifest.json);
  if (manifest.length.length_unit) {
    const std::string name = NameOf(*manifest.length.length_unit);
    const bool in_units =
        json.contains("units") && json["units"].is_object() && json["units"].contains("bvh_length");
    if (in_units) json["units"]["bvh_length"] = name;
    if (!in_units || json.contains("length_unit")) json["length_unit"] = name;
  }
  if (manifest.length.length_scale) json["length_scale"] = *manifest.length.length_scale;
  Json recordings = Json::array();
  for (const ManifestRecording& recording : manifest.recordings) {
    recordings.push_back(RecordingJson(recording));
  }
  json["recordings"] = recordings;
  return WriteJson(path, json, 1);
}

std::string ResolvePath(const std::string& manifest_path, const std::string& file) {
  // operator/ takes an absolute right-hand side as it is.
  return (std::filesystem::path(manifest_path).parent_path() / file).string();
}

std::string PathFromManifest(const std::string& manifest_path, const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path whole = fs::absolute(file);
  const fs::path path = fs::proximate(whole, fs::absolute(manifest_path).parent_path(), failed);
  return (failed ? whole : path).generic_string();
}

Result<std::vector<int>> SelectRecordings(const Manifest& manifest, const std::string& setting,
                                          const std::vector<std::string>& ids,
                                          const std::vector<std::string>& leave_out) {
  const std::vector<ManifestRecording>& all = manifest.recordings;
  std::vector<bool> in_setting(all.size(), false);
  for (const std::string& given : SplitList(setting + ",")) {
    const std::string_view name = Trimmed(given);
    bool found = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (name != all[i].labels.setting() && name != "all" &&
          !(name == "groups" && all[i].subjects.size() > 1)) {
        continue;
      }
      found = in_setting[i] = true;
    }
    if (found) continue;
    return Error{"--setting=" + setting + ": " +
                     (name == "groups" ? "no recording has more than one person"
                                       : "no recording has the setting " + Quoted(name)) +
                     "; there are " + SettingsOf(manifest) + ", besides all and groups",
                 manifest.path};
  }

  std::unordered_map<std::string, int> indices;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    indices[all[i].id] = static_cast<int>(i);
    known.push_back(all[i].id);
  }
  std::vector<bool> wanted(all.size(), ids.empty());
  for (const std::string& id : ids) {
    const auto at = indices.find(id);
    if (at == indices.end()) {
      return Error{
          "there is no recording " + Quoted(id) + "; it has " + ListOfNames(known, 6, "recordings"),
          manifest.path};
    }
    wanted[at->second] = true;
    const ManifestRecording& entry = all[at->second];
    if (in_setting[at->second]) continue;
    return Error{"recording " + Quoted(id) + " has the setting " + Quoted(entry.labels.setting()) +
                     ", which --setting=" + setting + " leaves out",
                 entry.manifest, entry.line};
  }
  std::vector<int> selected;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (wanted[i] && in_setting[i]) selected.push_back(static_cast<int>(i));
  }
  for (const std::string& id : leave_out) {
    const auto at = std::find_if(selected.begin(), selected.end(),
                                 [&](int index) { return all[index].id == id; });
    if (at == selected.end()) {
      return Error{"leave_out: there is no recording " + Quoted(id) + " among the selected ones",
                   manifest.path};
    }
    selected.erase(at);
  }
  if (!selected.empty() || leave_out.empty()) return selected;
  return Error{"leave_out leaves no recording", manifest.path};
}

std::vector<std::string> ManifestPaths(const std::string& list) {
  std::error_code ignored;
  if (list.find(',') == std::string::npos || std::filesystem::exists(list, ignored)) return {list};
  std::vector<std::string> paths;
  for (const std::string& path : SplitList(list)) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

Result<Manifest> ReadManifests(const std::string& list) {
  const std::vector<std::string> paths = ManifestPaths(list);
  if (paths.size() == 1) return ReadManifest(paths[0]);
  return Caught([&] {
    Manifest merged;
    // The place where an id was first given.
    struct Said {
      std::string path, where;
      double mass_kg = 0.0;
    };
    std::map<std::string, Said> ids, people;
    for (const std::string& path : paths) {
      Manifest manifest = OrThrow(ReadManifest(path));
      merged.path += (merged.path.empty() ? "" : ",") + path;
      (*merged.json)["manifests"].push_back(std::move(*manifest.json));
      for (ManifestRecording& entry : manifest.recordings) {
        const auto complain = [&](const std::string& problem) -> Error {
          return {"recording " + Quoted(entry.id) + ": " + problem, path, entry.line};
        };
        const std::string where = StrCat(path, ":", entry.line);
        const auto [id, new_id] = ids.emplace(entry.id, Said{path, where});
        if (!new_id) {
          throw complain("this id is in " + id->second.where +
                         " too; give one of them another, or leave one manifest out");
        }
        for (const ManifestSubject& subject : entry.subjects) {
          const Said& said =
              people.emplace(subject.id, Said{path, where, subject.mass_kg}).first->second;
          // Within a manifest people may gain weight; two studies' "S01" are hardly one person.
          if (said.path == path || said.mass_kg == subject.mass_kg) continue;
          throw complain(Quoted(subject.id) + " weighs " + Rounded(subject.mass_kg) +
                         " kg here and " + Rounded(said.mass_kg) + " kg in " + said.where +
                         "; other people need other ids");
        }
        if (!entry.length.Metres()) entry.length = manifest.length;
        merged.recordings.push_back(std::move(entry));
      }
    }
    return merged;
  });
}

Result<std::string> HashManifests(const std::string& list) {
  const std::vector<std::string> paths = ManifestPaths(list);
  if (paths.size() == 1) return HashFile(paths[0]);
  return Caught([&] {
    ContentHash hashes;
    for (const std::string& path : paths) hashes.Add(OrThrow(HashFile(path)));
    return hashes.Hex();
  });
}

}  // namespace pushid
