// datasets: keys near to known ones.
#include "datasets/manifest/manifest_keys.h"

#include <nlohmann/json.hpp>

#include "datasets/files/meant_name.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

std::vector<std::string> KnownKeys() {
  std::vector<std::string> keys = {
      "id",          "setting",     "fps",         "subjects",  "pushed_person",
      "mapping",     "push_csv",    "push_kind",   "magnitude", "joints",
      "up",          "forward",     "length_unit", "pushes",    "initial_velocity",
      "frames",      "first_frame", "end_frame",   "condition", kOldConditionKey,
      "length_scale"};
  for (const MotionFormatRow& row : kMotionFormats) keys.push_back(row.key);
  return keys;
}

}  // namespace

const std::vector<std::string>& ManifestKeys() {
  static const std::vector<std::string> keys = KnownKeys();
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

}  // namespace pushid
