// datasets: from a manifest to recordings in SI units, checked.
#include "datasets/loading/load_recordings.h"

#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/force_csv.h"
#include "datasets/loading/ground_record.h"
#include "datasets/loading/plate_record.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

// Puts the recording's name in front of what went wrong with one of its files.
Error OfRecording(const ManifestRecording& entry, Error error) {
  error.message = "recording " + Quoted(entry.id) + ": " + error.message;
  return error;
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

MaybeError LoadPush(const std::string& manifest, const ManifestPush& entry, ContentHash* hash,
                    Recording* recording) {
  Push push;
  push.person = entry.person;
  push.file = ResolvePath(manifest, entry.csv);
  push.start_frame = entry.start_frame;
  Result<std::vector<Eigen::Vector4d>> force = ReadPushCsv(push.file);
  if (!force.ok()) return force.error();
  push.force = std::move(force.value());
  if (MaybeError failed = CheckWithin(push, recording->num_frames())) return failed;
  const Result<std::string> file_hash = HashFile(push.file);
  if (!file_hash.ok()) return file_hash.error();
  hash->Add(file_hash.value());
  recording->pushes.push_back(std::move(push));
  return std::nullopt;
}

// Ground and platforms, at the frames of the motion as it is now.
MaybeError LoadLaboratory(const ManifestRecording& entry, const GroundReading& reading,
                          Recording* recording, Warnings* warnings) {
  if (entry.ground.given()) {
    Result<std::vector<GroundPose>> ground = LoadGround(entry, *recording, reading, warnings);
    if (!ground.ok()) return ground.error();
    recording->ground = std::move(ground.value());
  }
  for (const ManifestPlates& plates : entry.plates) {
    if (MaybeError failed = LoadPlates(entry, plates, reading.lowpass_hz, recording)) {
      return failed;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Recording> LoadRecording(const Manifest& manifest, const ManifestRecording& entry,
                                const LoadOptions& options, Warnings* warnings) {
  Recording recording;
  recording.id = entry.id;
  recording.labels = entry.labels;
  recording.pushed_person = entry.pushed_person;
  recording.push_kind = entry.push_kind;
  recording.initial_velocity = entry.initial_velocity;
  recording.stated_errors = entry.stated_errors;

  for (const std::string& misspelt : MisspeltKeys(entry)) {
    if (warnings == nullptr) continue;
    warnings->emplace_back("recording " + Quoted(entry.id) + " " + misspelt, entry.id, misspelt);
  }

  GroundReading reading;
  ContentHash hash;  // of the files' hashes, so that contents cannot slide from one into the next
  if (entry.plates_alone && !options.plates_alone) {
    return OfRecording(entry, {"was measured by force plates alone (\"motion\": \"none\"), which "
                               "only pushid-fit (--stance=fixed) and pushid-inspect can use; leave "
                               "it out (--leave_out), or name the files of its motion",
                               entry.manifest, entry.line});
  }
  for (std::size_t i = 0; i < entry.subjects.size(); ++i) {
    Result<LoadedPerson> loaded = entry.plates_alone
                                      ? LoadPersonOnPlates(entry)
                                      : LoadPerson(manifest, entry, i, options, warnings);
    if (!loaded.ok()) return OfRecording(entry, loaded.error());
    hash.Add(loaded.value().file_hash);
    RecordedPerson& person = loaded.value().person;
    if (i == 0) {
      recording.fps = loaded.value().fps;
      reading = {loaded.value().metres_per_unit, recording.fps, options.preparation.lowpass_hz};
    }
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
    if (MaybeError failed = LoadPush(entry.manifest, push, &hash, &recording)) {
      return OfRecording(entry, *std::move(failed));
    }
  }
  recording.content_hash = hash.Hex();
  if (MaybeError failed = PrepareMotion(options.preparation, &recording)) {
    return OfRecording(entry, *std::move(failed));
  }
  if (MaybeError failed = LoadLaboratory(entry, reading, &recording, warnings)) {
    return OfRecording(entry, *std::move(failed));
  }
  return recording;
}

Result<std::vector<Recording>> LoadRecordings(const std::string& manifests,
                                              const LoadOptions& options, Warnings* warnings) {
  if (MaybeError wrong = CheckPreparation(options.preparation)) return *std::move(wrong);
  const Result<Manifest> manifest = ReadManifests(manifests);
  if (!manifest.ok()) return manifest.error();
  return LoadRecordings(manifest.value(), options, warnings);
}

Result<std::vector<Recording>> LoadRecordings(const Manifest& manifest, const LoadOptions& options,
                                              Warnings* warnings) {
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

}  // namespace pushid
