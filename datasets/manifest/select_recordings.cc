// datasets: which of a manifest's recordings a run uses.
#include "datasets/manifest/select_recordings.h"

#include <algorithm>
#include <map>
#include <unordered_set>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// "group_1 (9), row_1 (13), single (32)"
std::string SettingsOf(const Manifest& manifest) {
  std::map<std::string, int> counts;
  for (const ManifestRecording& recording : manifest.recordings)
    ++counts[recording.labels.setting()];
  std::string text;
  for (const auto& [setting, count] : counts) {
    text += (text.empty() ? "" : ", ") + setting + " (" + std::to_string(count) + ")";
  }
  return text;
}

std::string SomeIdsOf(const Manifest& manifest) {
  constexpr std::size_t kListed = 6;
  std::string text;
  for (std::size_t i = 0; i < manifest.recordings.size() && i < kListed; ++i) {
    text += (i > 0 ? ", " : "") + manifest.recordings[i].id;
  }
  if (manifest.recordings.size() > kListed) {
    text += ", ... (" + std::to_string(manifest.recordings.size()) + " recordings)";
  }
  return text;
}

MaybeError LeaveOut(const Manifest& manifest, const std::vector<std::string>& ids,
                    std::vector<int>* selected) {
  for (const std::string& id : ids) {
    const auto at = std::find_if(selected->begin(), selected->end(),
                                 [&](int index) { return manifest.recordings[index].id == id; });
    if (at == selected->end()) {
      return Error{"leave_out: there is no recording " + Quoted(id) + " among the selected ones",
                   manifest.path, 0};
    }
    selected->erase(at);
  }
  if (!selected->empty() || ids.empty()) return std::nullopt;
  return Error{"leave_out leaves no recording", manifest.path, 0};
}

}  // namespace

Result<std::vector<int>> SelectRecordings(const Manifest& manifest, const std::string& setting,
                                          const std::vector<std::string>& ids,
                                          const std::vector<std::string>& leave_out) {
  const std::size_t count = manifest.recordings.size();
  std::vector<bool> in_setting(count, false);
  for (std::size_t begin = 0; begin <= setting.size();) {
    const std::size_t comma = std::min(setting.find(',', begin), setting.size());
    const std::string_view name = Trimmed(std::string_view(setting).substr(begin, comma - begin));
    begin = comma + 1;
    bool found = false;
    for (std::size_t i = 0; i < count; ++i) {
      const ManifestRecording& recording = manifest.recordings[i];
      if (name != recording.labels.setting() && name != "all" &&
          !(name == "groups" && recording.subjects.size() > 1)) {
        continue;
      }
      found = in_setting[i] = true;
    }
    if (!found) {
      return Error{"--setting=" + setting + ": " +
                       (name == "groups" ? "no recording has more than one person"
                                         : "no recording has the setting " + Quoted(name)) +
                       "; there are " + SettingsOf(manifest) + ", besides all and groups",
                   manifest.path, 0};
    }
  }

  const std::unordered_set<std::string> wanted(ids.begin(), ids.end());
  std::unordered_set<std::string> seen;
  std::vector<int> selected;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& id = manifest.recordings[i].id;
    if (!wanted.empty() && wanted.count(id) == 0) continue;
    seen.insert(id);
    if (in_setting[i]) {
      selected.push_back(static_cast<int>(i));
    } else if (!wanted.empty()) {
      return Error{"recording " + Quoted(id) + " has the setting " +
                       Quoted(manifest.recordings[i].labels.setting()) +
                       ", which --setting=" + setting + " leaves out",
                   manifest.recordings[i].manifest, manifest.recordings[i].line};
    }
  }
  for (const std::string& id : ids) {
    if (seen.count(id) == 0) {
      return Error{"there is no recording " + Quoted(id) + "; it has " + SomeIdsOf(manifest),
                   manifest.path, 0};
    }
  }
  if (MaybeError error = LeaveOut(manifest, leave_out, &selected)) return *error;
  return selected;
}

}  // namespace pushid
