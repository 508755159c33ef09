// apps: pushid-manifest by flag.
#include "apps/flags/manifest_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/manifest/recording.h"

DEFINE_string(folder, "", "the folder of the recordings, searched with its subfolders");
DEFINE_string(pattern, "",
              "paths of the motion files in the folder, as in {setting}/{subject}_{take}.c3d; "
              "{setting}, {subject}, {magnitude}, {condition} and {person} fill the manifest, any "
              "other {name} only tells recordings apart, * matches anything");
DEFINE_string(push_pattern, "", "paths of the push CSV files, with {names} from --pattern");
DEFINE_string(masses, "",
              "masses of the subjects: a CSV file id,mass_kg, or participants.tsv of Motion-BIDS");
DEFINE_double(mass_kg, pushid::ManifestOptions{}.mass_kg,
              "mass of everybody not listed in --masses");
DEFINE_double(fps, pushid::ManifestOptions{}.fps, "frames per second; 0: from each file");
DEFINE_int32(pushed_person, pushid::ManifestOptions{}.pushed_person,
             "index of the pushed person in recordings of several people, from 0");
DEFINE_string(setting, pushid::ManifestOptions{}.setting,
              "setting, if the pattern does not give it");
DEFINE_string(magnitude, pushid::ManifestOptions{}.magnitude,
              "strength of the push, if the pattern does not give it");
DEFINE_string(push_kind, pushid::Name(pushid::ManifestOptions{}.push_kind),
              "net, net_without_friction or external");
DEFINE_string(mapping, "", "mapping file for all recordings: joints, columns, unit, axes, rate");
DEFINE_string(up, "", "the files' axis that points up (z unless given)");
DEFINE_string(forward, "", "the files' axis that points in the push direction (x unless given)");
DEFINE_string(length_unit, "", "the files' unit: mm, cm or m");
DEFINE_double(length_scale, 0.0, "instead of a unit: metres per length unit of the files");
DEFINE_string(out, "", "write the manifest here (JSON)");
DEFINE_bool(update, pushid::ManifestFlags{}.update,
            "add to the existing manifest; entries whose id it already has stay unchanged");

namespace pushid {
namespace {

MaybeError CheckManifestFlags() {
  for (MaybeError missing :
       {Require("folder", FLAGS_folder, "name the folder of the recordings"),
        Require("pattern", FLAGS_pattern,
                "give the pattern of the file names, as in {subject}_{take}.bvh"),
        Require("out", FLAGS_out, "name the manifest to write")}) {
    if (missing) return missing;
  }
  if (!(FLAGS_mass_kg >= 0.0 && FLAGS_mass_kg <= 400.0)) {
    return Error{"--mass_kg must be a mass of at most 400 kg"};
  }
  if (FLAGS_fps != 0.0 && !(FLAGS_fps >= 1.0 && FLAGS_fps <= 1e4)) {
    return Error{"--fps must be from 1 to 10000 frames per second"};
  }
  if (FLAGS_pushed_person < 0) return Error{"--pushed_person counts from 0"};
  if (!FLAGS_update) {
    const MaybeError kept =
        CheckNew("out", FLAGS_out, ", --update adds what is new and keeps its entries");
    if (kept) return kept;
  }
  return CheckOutputFiles({FLAGS_out});
}

// The flags that name a choice or a file.
MaybeError ReadNamed(ManifestOptions* options) {
  if (!FLAGS_masses.empty()) {
    const auto masses = ReadMasses(FLAGS_masses);
    if (!masses.ok()) return masses.error();
    options->masses = masses.value();
  }
  const std::optional<PushKind> kind = PushKindFromName(FLAGS_push_kind);
  if (!kind) {
    return Error{"--push_kind is '" + FLAGS_push_kind +
                 "'; it must be net, net_without_friction or external"};
  }
  options->push_kind = *kind;
  if (FLAGS_length_scale != 0.0) {
    const std::string problem = LengthScaleProblem(FLAGS_length_scale);
    if (!problem.empty()) return Error{"--length_scale " + problem};
    if (!FLAGS_length_unit.empty()) {
      return Error{"--length_scale is given together with --length_unit; give one of them"};
    }
    options->length_scale = FLAGS_length_scale;
  }
  if (FLAGS_length_unit.empty()) return std::nullopt;
  options->length_unit = LengthUnitFromName(FLAGS_length_unit);
  if (options->length_unit) return std::nullopt;
  return Error{"--length_unit is '" + FLAGS_length_unit + "'; it must be mm, cm or m"};
}

}  // namespace

Result<ManifestFlags> ManifestFlagsFromCommandLine() {
  if (MaybeError error = CheckManifestFlags()) return *error;
  ManifestFlags flags;
  flags.update = FLAGS_update;
  ManifestOptions& options = flags.options;
  options.folder = FLAGS_folder;
  options.pattern = FLAGS_pattern;
  options.push_pattern = FLAGS_push_pattern;
  options.manifest_path = FLAGS_out;
  options.mass_kg = FLAGS_mass_kg;
  options.fps = FLAGS_fps;
  options.pushed_person = FLAGS_pushed_person;
  options.setting = FLAGS_setting;
  options.magnitude = FLAGS_magnitude;
  options.mapping = FLAGS_mapping;
  options.up = FLAGS_up;
  options.forward = FLAGS_forward;
  if (MaybeError error = ReadNamed(&options)) return *error;
  return flags;
}

}  // namespace pushid
