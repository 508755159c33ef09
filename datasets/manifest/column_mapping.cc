// datasets: mapping files, and what they share with manifests.
#include "datasets/manifest/column_mapping.h"

#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/manifest/recording.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

void ReadColumns(JsonFields* fields, ColumnMapping* mapping) {
  if (!fields->Has("columns")) return;
  const Json& columns = fields->At("columns");
  if (!columns.is_object()) {
    fields->Fail("columns", "must be an object of \"point\": [\"x\", \"y\", \"z\"]");
    return;
  }
  for (const auto& [name, item] : columns.items()) {
    bool names = item.is_array() && item.size() == 3;
    for (std::size_t i = 0; names && i < 3; ++i) names = item[i].is_string();
    if (!names || name.empty()) {
      fields->Fail("columns",
                   "of " + Quoted(name) + " must be three column names, not " + Shown(item));
      return;
    }
    mapping->columns.push_back(
        {name, item[0].get<std::string>(), item[1].get<std::string>(), item[2].get<std::string>()});
  }
}

constexpr int kHighestIndex = 1 << 30;
constexpr char kBase[] = "base";  // kBaseRole

std::optional<JointReference> ReadOne(const Json& value) {
  JointReference joint;
  if (value.is_string() && !value.get<std::string>().empty()) {
    joint.name = value.get<std::string>();
    return joint;
  }
  if (value.is_number_integer() && value.get<double>() >= 0 &&
      value.get<double>() < kHighestIndex) {
    joint.index = value.get<int>();
    return joint;
  }
  return std::nullopt;
}

std::optional<JointReference> ReadJoint(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  const Json& value = fields->At(key);
  std::optional<JointReference> joint = ReadOne(value);
  if (value.is_array() && !value.empty()) {
    joint.emplace();
    for (const Json& item : value) {
      const std::optional<JointReference> one = ReadOne(item);
      if (!one) {
        joint.reset();
        break;
      }
      joint->mean_of.push_back(*one);
    }
  }
  if (!joint) {
    fields->Fail(
        key, "must be a joint's name or its index from 0, or a list of those, not " + Shown(value));
  }
  return joint;
}

}  // namespace

Result<ColumnMapping> ReadColumnMapping(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  JsonFields fields(document.value(), document.value().content, "", "mapping");
  ColumnMapping mapping;
  if (fields.error()) return *fields.error();
  ReadColumns(&fields, &mapping);
  mapping.joints = ReadJointMapping(document.value(), &fields);
  mapping.time_column = fields.OptionalText("time", "");
  if (fields.Has("frame_rate")) {
    mapping.frame_rate = fields.Number("frame_rate", "the frames per second");
    const std::string problem = FrameRateProblem(mapping.frame_rate);
    if (!problem.empty()) fields.Fail("frame_rate", problem);
  }
  mapping.length_unit = ReadLengthUnit(&fields, "length_unit");
  mapping.length_scale = ReadLengthScale(&fields);
  mapping.up = fields.OptionalText("up", "");
  mapping.forward = fields.OptionalText("forward", "");
  if (mapping.up.empty() != mapping.forward.empty()) {
    fields.Fail(mapping.up.empty() ? "forward" : "up", "needs the other one: give up and forward");
  }
  if (!mapping.up.empty() && !fields.error()) {
    const Result<Eigen::Matrix3d> axes = AxesRotation(mapping.up, mapping.forward);
    if (!axes.ok()) fields.Fail("up", "and forward: " + axes.error().message);
  }
  fields.OnlyAsked();
  if (fields.error()) return *fields.error();
  return mapping;
}

std::optional<JointReference> JointMapping::Of(int role) const {
  if (role == kBodyHip) return hip;
  if (role == kLeftAnkle && left_ankle) return left_ankle;
  if (role == kRightAnkle && right_ankle) return right_ankle;
  const bool of_ankle = role == kLeftAnkle || role == kRightAnkle;
  const auto found = others.find(of_ankle ? kBaseRole : role);
  return found == others.end() ? std::nullopt : std::optional(found->second);
}

void JointMapping::Set(int role, const JointReference& joint) {
  if (role == kBodyHip) {
    hip = joint;
  } else if (role == kLeftAnkle) {
    left_ankle = joint;
  } else if (role == kRightAnkle) {
    right_ankle = joint;
  } else {
    others[role] = joint;
  }
}

JointMapping ReadJointMapping(const JsonDocument& document, JsonFields* fields) {
  JointMapping mapping;
  if (!fields->Has("joints")) return mapping;
  JsonFields joints(document, fields->At("joints"), fields->Pointer("joints"),
                    fields->label() + ", joints");
  for (int role = 0; role < kBodyJoints; ++role) {
    const std::optional<JointReference> joint = ReadJoint(&joints, RoleName(role).c_str());
    if (joint) mapping.Set(role, *joint);
  }
  // A robot's log has its base of support, and no ankles.
  if (const std::optional<JointReference> base = ReadJoint(&joints, kBase)) {
    if (mapping.left_ankle || mapping.right_ankle) {
      joints.Fail(kBase, "is given together with ankles; it stands for both of them");
    }
    mapping.others[kBaseRole] = *base;
  }
  joints.OnlyAsked();
  fields->Add(joints);
  return mapping;
}

std::optional<double> ReadLengthScale(JsonFields* fields) {
  constexpr const char* kKey = "length_scale";
  if (!fields->Has(kKey)) return std::nullopt;
  const double metres = fields->Number(kKey, "the metres in one of the file's lengths");
  if (fields->failed()) return std::nullopt;
  const std::string problem = LengthScaleProblem(metres);
  if (!problem.empty()) fields->Fail(kKey, problem);
  if (fields->Has("length_unit")) {
    fields->Fail(kKey, "is given together with length_unit; give one of them");
  }
  return metres;
}

std::optional<LengthUnit> ReadLengthUnit(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  return fields->Choice(key, LengthUnit::kMillimetre);
}

}  // namespace pushid
