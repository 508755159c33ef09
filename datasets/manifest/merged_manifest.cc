// datasets: several manifests as one.
#include "datasets/manifest/merged_manifest.h"

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/files/content_hash.h"
#include "datasets/files/number_text.h"

namespace pushid {
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
  std::stringstream words(list);
  for (std::string path; std::getline(words, path, ',');) {
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
