// apps: pushid-manifest: a manifest from a folder and a naming pattern.
#include <gflags/gflags.h>

#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/atomic_file.h"
#include "datasets/inspection/manifest_maker.h"
#include "datasets/manifest/recording_names.h"

DEFINE_string(folder, "", "the folder that holds the recordings, in it and below");
DEFINE_string(pattern, "",
              "paths of the motion files in the folder, as in {setting}/{subject}_{take}.c3d; "
              "setting, subject, magnitude, condition_code and person are understood, any other "
              "{name} tells recordings apart, * does not matter");
DEFINE_string(push_pattern, "", "paths of the push CSV files, with names of --pattern");
DEFINE_string(masses, "", "CSV file id,mass_kg of the subjects");
DEFINE_double(mass_kg, 0.0, "mass of everybody who is not in --masses");
DEFINE_double(fps, 0.0, "frames per second; 0: as each file says");
DEFINE_int32(pushed_person, 0, "who is pushed in recordings of several people, from 0");
DEFINE_string(setting, "single", "setting, where the pattern does not say");
DEFINE_string(magnitude, "unknown", "strength of the push, where the pattern does not say");
DEFINE_string(push_kind, "external", "net, net_without_friction or external");
DEFINE_string(mapping, "", "mapping file for all recordings: joints, columns, unit, axes, rate");
DEFINE_string(up, "", "the files' axis that points up (z unless given)");
DEFINE_string(forward, "", "the files' axis that points in the push direction (x unless given)");
DEFINE_string(length_unit, "", "the files' unit: mm, cm or m");
DEFINE_string(out, "", "write the manifest here (JSON)");

namespace {

using namespace pushid;

Result<ManifestOptions> OptionsFromFlags() {
  ManifestOptions options;
  options.folder = FLAGS_folder;
  options.pattern = FLAGS_pattern;
  options.push_pattern = FLAGS_push_pattern;
  options.manifest_path = FLAGS_out;
  if (!FLAGS_masses.empty()) {
    const auto masses = ReadMasses(FLAGS_masses);
    if (!masses.ok()) return masses.error();
    options.masses = masses.value();
  }
  if (!(FLAGS_mass_kg >= 0.0 && FLAGS_mass_kg <= 400.0)) {
    return Error{"--mass_kg must be a mass of at most 400 kg"};
  }
  options.mass_kg = FLAGS_mass_kg;
  if (FLAGS_fps != 0.0 && !(FLAGS_fps >= 1.0 && FLAGS_fps <= 1e4)) {
    return Error{"--fps must be from 1 to 10000 frames per second"};
  }
  options.fps = FLAGS_fps;
  if (FLAGS_pushed_person < 0) return Error{"--pushed_person counts from 0"};
  options.pushed_person = FLAGS_pushed_person;
  options.setting = FLAGS_setting;
  options.magnitude = FLAGS_magnitude;
  const std::optional<PushKind> kind = PushKindFromName(FLAGS_push_kind);
  if (!kind) {
    return Error{"--push_kind is '" + FLAGS_push_kind +
                 "'; it must be net, net_without_friction or external"};
  }
  options.push_kind = *kind;
  options.mapping = FLAGS_mapping;
  options.up = FLAGS_up;
  options.forward = FLAGS_forward;
  if (!FLAGS_length_unit.empty()) {
    options.length_unit = LengthUnitFromName(FLAGS_length_unit);
    if (!options.length_unit) {
      return Error{"--length_unit is '" + FLAGS_length_unit + "'; it must be mm, cm or m"};
    }
  }
  return options;
}

// No flag names the files that the patterns find.
MaybeError CheckFilesKept(const Manifest& manifest) {
  for (const ManifestRecording& recording : manifest.recordings) {
    std::vector<std::string> files = recording.motion;
    files.push_back(recording.push_csv);
    for (const std::string& file : files) {
      if (file.empty()) continue;
      if (MaybeError error = CheckNoOutput("--folder", ResolvePath(FLAGS_out, file))) return error;
    }
  }
  return std::nullopt;
}

int Run() {
  for (const auto& [flag, value, what] :
       {std::tuple{"folder", FLAGS_folder, "name the folder of the recordings"},
        std::tuple{"pattern", FLAGS_pattern,
                   "say how the files are named, as in {subject}_{take}.bvh"},
        std::tuple{"out", FLAGS_out, "name the manifest to write"}}) {
    if (MaybeError missing = Require(flag, value, what)) return Fail(*missing);
  }
  const Result<ManifestOptions> options = OptionsFromFlags();
  if (!options.ok()) return Fail(options.error());
  if (MaybeError error = CheckWritable(FLAGS_out)) return Fail(*error);
  const Result<MadeManifest> made = MakeManifest(options.value());
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = CheckFilesKept(made.value().manifest)) return Fail(*error);
  if (MaybeError error = WriteManifest(FLAGS_out, made.value().manifest)) return Fail(*error);
  for (const std::string& warning : made.value().warnings) Warn(warning);
  for (const Error& error : made.value().unreadable) Warn("left out: " + error.ToString());
  for (const std::string& id : made.value().without_push) Warn("recording " + id + " has no push");
  std::printf("%zu recordings from %d files (%d others in the folder) written to %s\n",
              made.value().manifest.recordings.size(), made.value().files, made.value().others,
              FLAGS_out.c_str());
  std::printf("look at them with: pushid-inspect %s\n", FLAGS_out.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-manifest makes the manifest of recordings whose file names follow a pattern.\n\n  "
      "pushid-manifest --folder=data --pattern='{setting}/{subject}_{magnitude}_{take}.c3d' "
      "--push_pattern='push/{subject}_{take}.csv' --masses=masses.csv --out=data/manifest.json",
      Run);
}
