// datasets: manifests merged, and recordings selected.
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

// "group_1 (9), row_1 (13), single (32)"
std::string SettingsOf(const Manifest& manifest) {
  std::map<std::string, int> counts;
  for (const ManifestRecording& recording : manifest.recordings)
    ++counts[recording.labels.setting()];
  std::vector<std::string> texts;
  for (const auto& [setting, count] : counts) {
    texts.push_back(setting + " (" + std::to_string(count) + ")");
  }
  return ListOfNames(texts);
}

std::string SomeIdsOf(const Manifest& manifest) {
  std::vector<std::string> ids;
  for (const ManifestRecording& recording : manifest.recordings) ids.push_back(recording.id);
  return ListOfNames(ids, 6, "recordings");
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

namespace {

namespace fs = std::filesystem;

// Where something was first said.
struct Said {
  std::string path;
  int line = 0;
  double mass_kg = 0.0;
  std::string Where() const { return path + ":" + std::to_string(line); }
};

class Merger {
 public:
  MaybeError Add(Manifest manifest) {
    merged_.path += (merged_.path.empty() ? "" : ",") + manifest.path;
    (*merged_.json)["manifests"].push_back(std::move(*manifest.json));
    for (ManifestRecording& entry : manifest.recordings) {
      if (MaybeError error = Check(manifest.path, entry)) return error;
      if (!entry.length_unit && !entry.length_scale) {
        entry.length_unit = manifest.length_unit;
        entry.length_scale = manifest.length_scale;
      }
      merged_.recordings.push_back(std::move(entry));
    }
    return std::nullopt;
  }

  Manifest Take() { return std::move(merged_); }

 private:
  MaybeError Check(const std::string& path, const ManifestRecording& entry) {
    const auto [id, new_id] = ids_.emplace(entry.id, Said{path, entry.line});
    if (!new_id) {
      return Error{"recording " + Quoted(entry.id) + ": this id is in " + id->second.Where() +
                       " too; give one of them another, or leave one manifest out",
                   path, entry.line};
    }
    for (const ManifestSubject& subject : entry.subjects) {
      const auto [said, is_new] =
          subjects_.emplace(subject.id, Said{path, entry.line, subject.mass_kg});
      // Within a manifest people may gain weight; two studies' "S01" are hardly one person.
      if (is_new || said->second.path == path || said->second.mass_kg == subject.mass_kg) continue;
      return Error{"recording " + Quoted(entry.id) + ": " + Quoted(subject.id) + " weighs " +
                       Rounded(subject.mass_kg) + " kg here and " + Rounded(said->second.mass_kg) +
                       " kg in " + said->second.Where() + "; other people need other ids",
                   path, entry.line};
    }
    return std::nullopt;
  }

  Manifest merged_;
  std::map<std::string, Said> ids_, subjects_;
};

}  // namespace

std::vector<std::string> ManifestPaths(const std::string& list) {
  std::error_code ignored;
  if (list.find(',') == std::string::npos || fs::exists(list, ignored)) return {list};
  std::vector<std::string> paths;
  for (const std::string& path : SplitList(list)) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

Result<Manifest> ReadManifests(const std::string& list) {
  const std::vector<std::string> paths = ManifestPaths(list);
  if (paths.size() == 1) return ReadManifest(paths[0]);
  Merger merger;
  for (const std::string& path : paths) {
    Result<Manifest> manifest = ReadManifest(path);
    if (!manifest.ok()) return manifest;
    if (MaybeError error = merger.Add(std::move(manifest.value()))) return *error;
  }
  return merger.Take();
}

Result<std::string> HashManifests(const std::string& list) {
  const std::vector<std::string> paths = ManifestPaths(list);
  if (paths.size() == 1) return HashFile(paths[0]);
  ContentHash hashes;
  for (const std::string& path : paths) {
    const Result<std::string> hash = HashFile(path);
    if (!hash.ok()) return hash;
    hashes.Add(hash.value());
  }
  return hashes.Hex();
}

}  // namespace pushid
