// datasets: joints and units in manifests and mapping files.
#include "datasets/manifest/mapping_json.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kHighestIndex = 1 << 30;

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

JointMapping ReadJointMapping(const JsonDocument& document, JsonFields* fields) {
  JointMapping mapping;
  if (!fields->Has("joints")) return mapping;
  JsonFields joints(document, fields->At("joints"), fields->Pointer("joints"),
                    fields->label() + ", joints");
  joints.Only({"hip", "left_ankle", "right_ankle"});
  mapping.hip = ReadJoint(&joints, "hip");
  mapping.left_ankle = ReadJoint(&joints, "left_ankle");
  mapping.right_ankle = ReadJoint(&joints, "right_ankle");
  fields->Add(joints);
  return mapping;
}

std::optional<LengthUnit> ReadLengthUnit(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  return fields->Choice(key, &LengthUnitFromName, LengthUnit::kMillimetre, "mm, cm or m");
}

}  // namespace pushid
