// apps: loading what --recordings names.
#include "apps/flags/recording_flags.h"

#include <set>

#include "datasets/inspection/findings.h"

const std::string kUnitHelp = "length unit of the files, " + pushid::AnyName<pushid::LengthUnit>() +
                              "; overrides the files and the manifest";

DEFINE_string(recordings, "", "manifest.json of the recordings, or several, comma-separated");
DEFINE_string(setting, pushid::LoadOptions{}.setting,
              "recordings to use: settings of the manifest, comma-separated; groups (more than one "
              "person); all");
DEFINE_string(ids, "", "only these recordings, comma-separated ids");
DEFINE_string(leave_out, "", "all but these recordings, comma-separated ids");
DEFINE_string(length_unit, "", kUnitHelp.c_str());
DEFINE_double(length_scale, 0.0,
              "instead of --length_unit: metres per length unit of the files, as in 0.0564; 0: "
              "use the unit");
DEFINE_double(max_gap_s, pushid::PreparationOptions{}.max_gap_s,
              "interpolate gaps in markers up to this long, s; frames of longer ones are left out");
DEFINE_double(lowpass_hz, pushid::PreparationOptions{}.lowpass_hz,
              "zero-phase Butterworth low-pass of all positions (second order, forwards and "
              "backwards), cut-off in Hz; 0: none");
DEFINE_double(resample_fps, pushid::PreparationOptions{}.resample_fps,
              "resample motion and pushes to this many frames per second; 0: as recorded");

namespace pushid {
namespace {

LoadOptions LoadOptionsOfFlags() {
  LoadOptions options;
  options.setting = FLAGS_setting;
  options.preparation = {FLAGS_max_gap_s, FLAGS_lowpass_hz, FLAGS_resample_fps};
  options.ids = SplitList(FLAGS_ids);
  options.leave_out = SplitList(FLAGS_leave_out);
  options.length = OrFail(ChooseLength("--", FLAGS_length_unit, FLAGS_length_scale));
  OrFail(CheckPreparation(options.preparation));
  return options;
}

// Ids of the fitted recordings, each once; none where the flags choose others.
std::vector<std::string> FittedIds(const FitResult& fit) {
  std::vector<std::string> ids;
  const bool all = FLAGS_ids.empty() && FLAGS_leave_out.empty();
  if (!all || FLAGS_setting != LoadOptions{}.setting) return ids;
  // A replica of a bootstrap has a recording several times.
  std::set<std::string> seen;
  for (const FittedRecording& fitted : fit.recordings) {
    if (seen.insert(fitted.id).second) ids.push_back(fitted.id);
  }
  return ids;
}

}  // namespace

void LoadAs(const std::map<std::string, std::string>& configuration) {
  const bool unit_given = Given("length_unit") || Given("length_scale");
  const std::map<std::string, std::string> now = EffectiveFlags();
  for (const char* flag : kLoadFlags) {
    const auto value = configuration.find(flag);
    const bool of_unit = std::string(flag).rfind("length_", 0) == 0;
    if (value == configuration.end() || (of_unit ? unit_given : Given(flag))) continue;
    // A default that is set counts as given.
    if (value->second == now.at(flag)) continue;
    gflags::SetCommandLineOption(flag, value->second.c_str());
  }
}

void CheckRecordingFlags() { LoadOptionsOfFlags(); }

const Result<Manifest>& FlaggedManifest() {
  static const Result<Manifest> manifest = ReadManifests(FLAGS_recordings);
  return manifest;
}

std::vector<std::string> SelectedIds() {
  Require("recordings", FLAGS_recordings, "give the manifest.json of your recordings");
  const Manifest manifest = OrFail(FlaggedManifest());
  const LoadOptions options = LoadOptionsOfFlags();
  std::vector<std::string> ids;
  for (int index :
       OrFail(SelectRecordings(manifest, options.setting, options.ids, options.leave_out))) {
    ids.push_back(manifest.recordings[index].id);
  }
  return ids;
}

std::vector<Recording> LoadFlaggedRecordings(const std::vector<std::string>& ids,
                                             bool keep_all_joints, Warnings* warnings,
                                             bool plates_alone) {
  Require("recordings", FLAGS_recordings, "give the manifest.json of your recordings");
  LoadOptions options = LoadOptionsOfFlags();
  options.keep_all_joints = keep_all_joints;
  options.plates_alone = plates_alone;
  if (!ids.empty()) {
    options.ids = ids;
    options.leave_out.clear();
  }
  const Result<Manifest>& manifest = FlaggedManifest();
  if (!manifest.ok()) throw manifest.error();
  Warnings found;
  Result<std::vector<Recording>> recordings = LoadRecordings(manifest.value(), options, &found);
  if (recordings.ok()) {
    const Warnings facing = FindingWarnings(FacingFindings(recordings.value()));
    found.insert(found.end(), facing.begin(), facing.end());
  }
  WarnGrouped(found);
  if (warnings != nullptr) *warnings = found;
  if (!recordings.ok()) throw recordings.error();
  // Pushes may be written where they were read; a motion must not be overwritten.
  for (const ManifestRecording& entry : manifest.value().recordings) {
    std::vector<std::string> files = entry.motion;
    if (!entry.mapping.empty()) files.push_back(entry.mapping);
    for (const std::string& file : files) {
      OrFail(CheckNotRead("recording " + entry.id, ResolvePath(entry.manifest, file)));
    }
  }
  return std::move(recordings).value();
}

std::vector<Recording> LoadFittedRecordings(const FitResult& fit, bool keep_all_joints) {
  const std::vector<std::string> ids = FittedIds(fit);
  if (!ids.empty() && !FLAGS_recordings.empty() && FlaggedManifest().ok()) {
    const Manifest& manifest = FlaggedManifest().value();
    for (const std::string& id : ids) {
      const bool known =
          std::any_of(manifest.recordings.begin(), manifest.recordings.end(),
                      [&id](const ManifestRecording& entry) { return entry.id == id; });
      if (known) continue;
      throw Error{"there is no recording " + Quoted(id) +
                      ", to which the model was fitted; give the manifest of the fit "
                      "(pushid-report shows other recordings with --ids or --setting)",
                  manifest.path, 0};
    }
  }
  return LoadFlaggedRecordings(ids, keep_all_joints);
}

std::vector<Recording> LoadBodiesOfSetting(const std::string& setting) {
  const gflags::FlagSaver saver;
  FLAGS_setting = setting;
  FLAGS_ids.clear();
  return LoadFlaggedRecordings({}, true);
}

Provenance ProvenanceOfRun() {
  Provenance from;
  from.version = Version();
  from.configuration = EffectiveFlags();
  // The place of the data is no part of a result; their hash is.
  from.configuration.erase("recordings");
  from.changed_flags = ChangedFlags();
  from.manifest = FLAGS_recordings;
  from.setting = FLAGS_setting;
  const Result<std::string> hash = HashManifests(FLAGS_recordings);
  if (hash.ok()) from.manifest_hash = hash.value();
  return from;
}

void CheckPushed(const std::vector<Recording>& recordings) {
  for (const Recording& recording : recordings) {
    if (!recording.pushes.empty() || !recording.ground.empty()) continue;
    if (recording.people[0].weight == std::vector<double>(recording.num_frames(), 0.0)) {
      throw Error{"recording " + recording.id +
                      " was measured by force plates alone, on ground that does not move, so "
                      "nothing explains the motion; give its \"ground\", or leave it out "
                      "(--leave_out)",
                  FLAGS_recordings};
    }
    throw Error{"recording " + recording.id +
                    " has neither a push nor moving ground: estimate a push with pushid-push, or "
                    "leave it out (--leave_out)",
                FLAGS_recordings};
  }
}

}  // namespace pushid
