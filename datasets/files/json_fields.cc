// datasets: what is missing, in one sentence for each object.
#include "datasets/files/json_fields.h"

#include <map>
#include <set>

namespace pushid {
namespace {

using ObjectKeys = std::vector<const MissingKey*>;  // of one object

// In the order in which objects first lack something.
std::vector<ObjectKeys> ByObject(const std::vector<MissingKey>& missing) {
  std::vector<ObjectKeys> objects;
  std::map<std::string, std::size_t> index;  // by label
  for (const MissingKey& key : missing) {
    const auto [at, is_new] = index.emplace(key.label, objects.size());
    if (is_new) objects.emplace_back();
    objects[at->second].push_back(&key);
  }
  return objects;
}

// "a, b and c are missing"
std::string KeysText(const ObjectKeys& keys) {
  std::vector<std::string> names;
  for (const MissingKey* key : keys) names.push_back(key->key);
  return Listed(names, "and") + (keys.size() == 1 ? " is missing" : " are missing");
}

}  // namespace

std::string MissingText(const std::vector<MissingKey>& missing) {
  constexpr std::size_t kMostObjects = 8;
  const std::vector<ObjectKeys> objects = ByObject(missing);
  std::string text;
  std::set<std::string> explained;  // each key once
  for (std::size_t i = 0; i < objects.size() && i < kMostObjects; ++i) {
    const ObjectKeys& keys = objects[i];
    text += (i == 0 ? "" : "; ") + keys[0]->label + ": " + KeysText(keys);
    for (const MissingKey* key : keys) {
      if (!explained.insert(key->key).second) continue;
      text += "; " + (keys.size() == 1 ? "it" : key->key) + " must be " + key->what;
    }
  }
  if (objects.size() > kMostObjects) {
    text += "; and " + std::to_string(objects.size() - kMostObjects) + " more lack keys";
  }
  return text;
}

}  // namespace pushid
