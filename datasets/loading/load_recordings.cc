// datasets: from a manifest to recordings in SI units, checked.
#include "datasets/loading/load_recordings.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_bids.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

// Puts the recording's name in front of what went wrong with one of its files.
Error OfRecording(const ManifestRecording& entry, Error error) {
  error.message = "recording " + Quoted(entry.id) + ": " + error.message;
  return error;
}

// One, or several where a Motion-BIDS file holds them; frames count from the push's own start.
Result<std::vector<TimedForce>> ReadPushFile(const std::string& path) {
  if (MotionFormatOfFile(path) == MotionFormat::kBids) return ReadBidsPushes(path);
  Result<std::vector<Eigen::Vector4d>> force = ReadPushCsv(path);
  if (!force.ok()) return force.error();
  return std::vector<TimedForce>{{0, std::move(force.value())}};
}

MaybeError CheckWithin(const Push& push, int num_frames) {
  const std::string motion = "the motion has " + std::to_string(num_frames) + " frames";
  if (push.start_frame > num_frames - 2) {
    return Error{"the push starts at frame " + std::to_string(push.start_frame) + ", but " + motion,
                 push.file, 0};
  }
  // One row per frame is fine: a sensor records as long as the cameras, its last row drives no
  // step.
  if (push.force.size() <= static_cast<std::size_t>(num_frames - push.start_frame)) {
    return std::nullopt;
  }
  return Error{"the push is longer than the motion: it has " + std::to_string(push.force.size()) +
                   " rows" +
                   (push.start_frame > 0 ? " from frame " + std::to_string(push.start_frame) : "") +
                   ", " + motion,
               push.file, 0};
}

MaybeError LoadPushes(const std::string& manifest, const ManifestPush& entry, ContentHash* hash,
                      Recording* recording) {
  Push push;
  push.person = entry.person;
  push.file = ResolvePath(manifest, entry.csv);
  Result<std::vector<TimedForce>> read = ReadPushFile(push.file);
  if (!read.ok()) return read.error();
  for (TimedForce& timed : read.value()) {
    push.start_frame = entry.start_frame + timed.start_frame;
    push.force = std::move(timed.force);
    if (MaybeError failed = CheckWithin(push, recording->num_frames())) return failed;
    recording->pushes.push_back(push);
  }
  const Result<std::string> file_hash = HashFile(push.file);
  if (!file_hash.ok()) return file_hash.error();
  hash->Add(file_hash.value());
  return std::nullopt;
}

}  // namespace

Result<Recording> LoadRecording(const Manifest& manifest, const ManifestRecording& entry,
                                const LoadOptions& options, std::vector<std::string>* warnings) {
  Recording recording;
  recording.id = entry.id;
  recording.labels = entry.labels;
  recording.pushed_person = entry.pushed_person;
  recording.push_kind = entry.push_kind;
  recording.initial_velocity = entry.initial_velocity;

  for (const std::string& misspelt : MisspeltKeys(entry)) {
    if (warnings != nullptr) warnings->push_back("recording " + Quoted(entry.id) + " " + misspelt);
  }

  ContentHash hash;  // of the files' hashes, so that contents cannot slide from one into the next
  for (std::size_t i = 0; i < entry.motion.size(); ++i) {
    Result<LoadedPerson> loaded = LoadPerson(manifest, entry, i, options, warnings);
    if (!loaded.ok()) return OfRecording(entry, loaded.error());
    hash.Add(loaded.value().file_hash);
    RecordedPerson& person = loaded.value().person;
    if (i == 0) recording.fps = loaded.value().fps;
    if (loaded.value().fps != recording.fps) {
      return OfRecording(
          entry, {"the file gives " + Rounded(loaded.value().fps) + " frames per second, but " +
                      recording.people[0].file + " gives " + Rounded(recording.fps) +
                      "; give the right one as fps in the manifest",
                  person.file});
    }
    if (i > 0 && person.hip.size() != recording.people[0].hip.size()) {
      return OfRecording(entry, {"the file has " + std::to_string(person.hip.size()) +
                                     " frames, but " + recording.people[0].file + " has " +
                                     std::to_string(recording.people[0].hip.size()) +
                                     "; the people of one recording share their frames",
                                 person.file, 0});
    }
    recording.people.push_back(std::move(person));
  }

  std::vector<ManifestPush> pushes = entry.pushes;
  if (!entry.push_csv.empty()) {
    pushes.insert(pushes.begin(), ManifestPush{entry.pushed_person, entry.push_csv, 0});
  }
  for (const ManifestPush& push : pushes) {
    if (MaybeError failed = LoadPushes(entry.manifest, push, &hash, &recording)) {
      return OfRecording(entry, *std::move(failed));
    }
  }
  recording.content_hash = hash.Hex();
  if (MaybeError failed = PrepareMotion(options.preparation, &recording)) {
    return OfRecording(entry, *std::move(failed));
  }
  return recording;
}

Result<std::vector<Recording>> LoadRecordings(const std::string& manifests,
                                              const LoadOptions& options,
                                              std::vector<std::string>* warnings) {
  if (MaybeError wrong = CheckPreparation(options.preparation)) return *std::move(wrong);
  const Result<Manifest> manifest = ReadManifests(manifests);
  if (!manifest.ok()) return manifest.error();
  return LoadRecordings(manifest.value(), options, warnings);
}

Result<std::vector<Recording>> LoadRecordings(const Manifest& manifest, const LoadOptions& options,
                                              std::vector<std::string>* warnings) {
  if (MaybeError wrong = CheckPreparation(options.preparation)) return *std::move(wrong);
  const Result<std::vector<int>> selected =
      SelectRecordings(manifest, options.setting, options.ids, options.leave_out);
  if (!selected.ok()) return selected.error();
  std::vector<Recording> recordings;
  for (int index : selected.value()) {
    Result<Recording> recording =
        LoadRecording(manifest, manifest.recordings[index], options, warnings);
    if (!recording.ok()) return recording.error();
    recordings.push_back(std::move(recording.value()));
  }
  return recordings;
}

namespace {

constexpr size_t kNamed = 3;  // recordings of a group that it names
constexpr char kRecording[] = "recording ";

struct Group {
  std::string key, first;        // what is the same; the first warning, whole
  std::vector<std::string> ids;  // empty: of no recording
  int count = 0;
};

// "a.bvh", "walks/a.c3d"
bool IsFileName(const std::string& word) {
  const size_t dot = word.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == word.size()) return false;
  return std::all_of(word.begin() + static_cast<long>(dot) + 1, word.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0; });
}

// "recording 'a b': a.bvh has" and "recording a: it has".
Group Read(const std::string& warning) {
  Group read{warning, warning, {}, 1};
  if (warning.rfind(kRecording, 0) != 0) return read;
  size_t begin = sizeof kRecording - 1;
  const bool quoted = warning[begin] == '\'';
  begin += quoted ? 1 : 0;
  const size_t end = warning.find(quoted ? '\'' : ':', begin);
  if (end == std::string::npos) return read;
  read.ids = {warning.substr(begin, end - begin)};
  read.key = warning.substr(end + (quoted ? 1 : 0));
  if (read.key.rfind(": ", 0) != 0) return read;
  const std::string word = read.key.substr(2, read.key.find(' ', 2) - 2);
  if (IsFileName(word)) read.key.replace(2, word.size(), "the file");
  return read;
}

std::string Text(const Group& group) {
  const std::string count = std::to_string(group.count);
  if (group.count == 1) return group.first;
  if (group.ids.size() < 2) return group.first + " (" + count + " times)";
  std::string names;
  for (size_t i = 0; i < std::min(kNamed, group.ids.size()); ++i) {
    names += (i > 0 ? ", " : "") + group.ids[i];
  }
  const std::string more = group.ids.size() > kNamed ? ", ..." : "";
  const std::string colon = group.key.rfind(':', 0) == 0 ? "" : ":";
  return "in " + std::to_string(group.ids.size()) + " recordings (" + names + more + ")" + colon +
         group.key;
}

}  // namespace

std::string RecordingWarning(const std::string& id, const std::string& what) {
  return kRecording + Quoted(id) + ": " + what;
}

std::vector<std::string> GroupedWarnings(const std::vector<std::string>& warnings) {
  std::vector<Group> groups;
  for (const std::string& warning : warnings) {
    const Group read = Read(warning);
    const auto same = std::find_if(groups.begin(), groups.end(), [&read](const Group& group) {
      return group.key == read.key && group.ids.empty() == read.ids.empty();
    });
    if (same == groups.end()) {
      groups.push_back(read);
      continue;
    }
    ++same->count;
    // One recording may say it of several people.
    for (const std::string& id : read.ids) {
      const bool known = std::find(same->ids.begin(), same->ids.end(), id) != same->ids.end();
      if (!known) same->ids.push_back(id);
    }
  }
  std::vector<std::string> texts;
  for (const Group& group : groups) texts.push_back(Text(group));
  return texts;
}

}  // namespace pushid
