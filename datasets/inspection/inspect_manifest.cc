// datasets: what a manifest lists.
#include "datasets/inspection/inspect_manifest.h"

#include <map>
#include <set>

#include "datasets/files/list_of_names.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/inspection/plausibility.h"
#include "datasets/loading/load_recordings.h"

namespace pushid {
MaybeError InspectManifest(Inspection* found) {
  const Result<Manifest> manifest = ReadManifest(found->path);
  if (!manifest.ok()) return manifest.error();
  std::map<std::string, int> settings, formats;
  std::set<std::string> subjects;
  int pushed = 0, read = 0;
  PlausibilityCheck plausible;
  for (const ManifestRecording& entry : manifest.value().recordings) {
    ++settings[entry.labels.setting()];
    ++formats[Title(entry.motion_format)];
    for (const ManifestSubject& subject : entry.subjects) subjects.insert(subject.id);
    pushed += entry.push_csv.empty() && entry.pushes.empty() ? 0 : 1;
    const Result<Recording> recording =
        LoadRecording(manifest.value(), entry, {}, &found->warnings);
    if (recording.ok()) ++read;
    if (recording.ok()) plausible.Look(recording.value());
    if (!recording.ok()) found->Warn(recording.error().ToString());
  }
  for (const std::string& warning : plausible.Warnings()) found->Warn(warning);
  const auto counts = [](const std::map<std::string, int>& of) {
    std::vector<std::string> texts;
    for (const auto& [name, count] : of) texts.push_back(name + " " + std::to_string(count));
    return ListOfNames(texts);
  };
  const std::size_t all = manifest.value().recordings.size();
  found->Fact("recordings", std::to_string(all) + ", " + std::to_string(read) + " can be read, " +
                                std::to_string(pushed) + " have a push");
  found->Fact("settings", counts(settings));
  found->Fact("formats", counts(formats));
  found->Fact("subjects", ListOfNames({subjects.begin(), subjects.end()}));
  return std::nullopt;
}

}  // namespace pushid
