// datasets: the manifest written, with everything that was in it before.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/manifest/body_roles.h"
#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

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

// The same for keys whose default value may as well be spelled out.
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

// What was under `key` when it is a list of `size` objects, so that their other keys stay;
// otherwise a list of that many empty ones.
Json ObjectsUnder(const Json& object, const char* key, std::size_t size) {
  Json list = object.contains(key) ? object.at(key) : Json();
  bool usable = list.is_array() && list.size() == size;
  if (usable) {
    for (const Json& item : list) usable = usable && item.is_object();
  }
  return usable ? list : Json(size, Json::object());
}

// The pendulum's first, as people write them.
std::vector<int> WrittenRoles() {
  std::vector<int> roles = {kBodyHip, kLeftAnkle, kRightAnkle};
  for (int role = 0; role < kBodyJoints; ++role) {
    if (std::find(roles.begin(), roles.end(), role) == roles.end()) roles.push_back(role);
  }
  return roles;
}

Json JointsJson(const JointMapping& joints, const Json& object) {
  Json json = object.contains("joints") ? object.at("joints") : Json::object();
  for (int role : WrittenRoles()) {
    const std::optional<JointReference> joint = joints.Of(role);
    SetUnless(!joint.has_value(), RoleName(role).c_str(), joint ? JointJson(*joint) : Json(),
              &json);
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
  SetUnless(labels.magnitude().empty(), kMagnitudeLabel, labels.magnitude(), &json);
  // A file that has both keeps both; one that has the old key alone gets the new one.
  if (!json.contains(kConditionLabel)) json.erase(kOldConditionKey);
  SetOrKeep(labels.condition().empty(), kConditionLabel, labels.condition(), &json);
  for (const std::string& key : labels.Keys()) json[key] = labels.Of(key);
  const Json joints = JointsJson(recording.joints, json);
  SetUnless(joints.empty(), "joints", joints, &json);
  SetOrKeep(recording.up == "z", "up", recording.up, &json);
  SetOrKeep(recording.forward == "x", "forward", recording.forward, &json);
  SetUnless(!recording.length_unit, "length_unit",
            recording.length_unit ? NameOf(*recording.length_unit) : "", &json);
  SetUnless(!recording.length_scale, "length_scale", recording.length_scale.value_or(0.0), &json);
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

}  // namespace

ManifestRecording EntryOf(const Recording& recording) {
  ManifestRecording entry;
  entry.id = recording.id;
  entry.labels = recording.labels;
  entry.fps = recording.fps;
  entry.frames = recording.num_frames();
  entry.pushed_person = recording.pushed_person;
  entry.push_kind = recording.push_kind;
  entry.initial_velocity = recording.initial_velocity;
  return entry;
}

MaybeError WriteManifest(const std::string& path, const Manifest& manifest) {
  Json json = Json::object();
  if (manifest.path.empty()) json["schema"] = "pushid-manifest/1";  // what was read stays as it was
  if (manifest.json->is_object()) json.update(*manifest.json);
  if (manifest.length_unit) {
    const std::string name = NameOf(*manifest.length_unit);
    const bool in_units =
        json.contains("units") && json["units"].is_object() && json["units"].contains("bvh_length");
    if (in_units) json["units"]["bvh_length"] = name;
    if (!in_units || json.contains("length_unit")) json["length_unit"] = name;
  }
  if (manifest.length_scale) json["length_scale"] = *manifest.length_scale;
  Json recordings = Json::array();
  for (const ManifestRecording& recording : manifest.recordings) {
    bool finite = std::isfinite(recording.fps);
    for (const ManifestSubject& subject : recording.subjects) {
      finite = finite && std::isfinite(subject.mass_kg);
    }
    if (!finite) {
      return Error{
          "recording " + recording.id + " cannot be written: its fps or a mass is not finite", path,
          0};
    }
    recordings.push_back(RecordingJson(recording));
  }
  json["recordings"] = recordings;
  return WriteJson(path, json, 1);
}

std::string ResolvePath(const std::string& manifest_path, const std::string& file) {
  // operator/ takes an absolute right-hand side as it is.
  return (std::filesystem::path(manifest_path).parent_path() / file).string();
}

}  // namespace pushid
