// datasets: keys near to known ones.
#include "datasets/manifest/manifest_keys.h"

#include <algorithm>
#include <numeric>

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

// Letters to put in, take out or replace (Levenshtein), hyphens and capitals aside.
std::size_t Distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, row[k] + 1, row[k + 1] + 1});
    }
  }
  return row.back();
}

std::string Plain(std::string key) {
  for (char& c : key) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(c));
  return key;
}

}  // namespace

std::string MeantBy(const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return "";
  std::string nearest;
  std::size_t least = 3;
  for (const std::string& one : known) {
    // Short words are near to too much.
    const std::size_t most = one.size() < 5 ? 0 : 2;
    const std::size_t distance = Distance(Plain(word), one);
    if (distance > most || distance >= least) continue;
    nearest = one;
    least = distance;
  }
  return nearest;
}

const std::vector<std::string>& ManifestKeys() {
  static const std::vector<std::string> keys = KnownKeys();
  return keys;
}

std::vector<std::string> MisspeltKeys(const ManifestRecording& entry) {
  std::vector<std::string> found;
  if (!entry.json.is_object()) return found;
  for (const auto& [key, value] : entry.json.items()) {
    const std::string meant = MeantBy(key, ManifestKeys());
    if (meant.empty()) continue;
    found.push_back("has the key " + Quoted(key) + ", which is not known and not used; is " +
                    meant + " meant?");
  }
  return found;
}

}  // namespace pushid
