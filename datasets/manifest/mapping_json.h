// datasets: what manifests and mapping files say in the same words: joints and units.
#pragma once

#include <optional>

#include "datasets/files/json_fields.h"
#include "datasets/formats/length_unit.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// "joints": {"hip": "Hips" or 0 or ["LASI", "RASI"], "left_ankle": ..., "left_knee": ...}: any role
// of body_roles.h, all optional.
JointMapping ReadJointMapping(const JsonDocument& document, JsonFields* fields);

// "mm", "cm" or "m"; nullopt when the key is not there.
std::optional<LengthUnit> ReadLengthUnit(JsonFields* fields, const char* key);

// "length_scale", the metres in one of the file's lengths; nullopt when the key is not there.
// Beside "length_unit" it is a mistake.
std::optional<double> ReadLengthScale(JsonFields* fields);

}  // namespace pushid
