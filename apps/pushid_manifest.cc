// apps: pushid-manifest: a manifest from a folder and a naming pattern.
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/inspection/inspection.h"
#include "datasets/inspection/manifest_maker.h"

const std::string kUnitHelp = "the files' unit: " + pushid::AnyName<pushid::LengthUnit>();
const std::string kPushKindHelp = pushid::AnyName<pushid::PushKind>();

DEFINE_string(folder, "", "the folder of the recordings, searched with its subfolders");
DEFINE_string(pattern, "",
              "paths of the motion files in the folder, as in {setting}/{subject}_{take}.c3d; "
              "{setting}, {subject}, {magnitude}, {condition} and {person} fill the manifest, any "
              "other {name} only tells recordings apart, * matches anything");
DEFINE_string(push_pattern, "", "paths of the push CSV files, with {names} from --pattern");
DEFINE_string(masses, "",
              "masses of the subjects: a CSV file id,mass_kg; further columns (group, height, ...) "
              "are kept as what is known of them");
DEFINE_double(mass, pushid::ManifestOptions{}.mass_kg, "mass of everybody not listed in --masses");
DEFINE_double(fps, pushid::ManifestOptions{}.fps, "frames per second; 0: from each file");
DEFINE_string(setting, pushid::ManifestOptions{}.setting,
              "setting, if the pattern does not give it");
DEFINE_string(push_kind, pushid::NameOf(pushid::ManifestOptions{}.push_kind),
              kPushKindHelp.c_str());
DEFINE_string(mapping, "", "mapping file for all recordings: joints, columns, unit, axes, rate");
DEFINE_string(up, "", "the files' axis that points up (z unless given)");
DEFINE_string(forward, "", "the files' axis that points in the push direction (x unless given)");
DEFINE_string(length_unit, "", kUnitHelp.c_str());
DEFINE_double(length_scale, 0.0, "instead of a unit: metres per length unit of the files");
DEFINE_string(set, "",
              "any other key of all recordings, KEY=VALUE, as in group=older or "
              "force_plates.file=plates/{id}.csv (csv under ground: ground.csv), with {id} and "
              "names from --pattern; may be repeated");
DEFINE_string(out, "", "write the manifest here (JSON)");
DEFINE_bool(update, false,
            "add to the existing manifest; entries whose id it already has stay unchanged");

namespace {

using namespace pushid;

ManifestOptions OptionsFromFlags() {
  Require("folder", FLAGS_folder, "name the folder of the recordings");
  Require("pattern", FLAGS_pattern,
          "give the pattern of the file names, as in {subject}_{take}.bvh");
  Require("out", FLAGS_out, "name the manifest to write");
  CheckRange("mass", FLAGS_mass, 0, 400);
  if (FLAGS_fps != 0.0) CheckRange("fps", FLAGS_fps, 1, 10000);
  if (!FLAGS_update) {
    OrFail(CheckNew("out", FLAGS_out, ", --update adds what is new and keeps its entries"));
  }
  OrFail(CheckOutputFiles({FLAGS_out}));
  ManifestOptions options;
  options.folder = FLAGS_folder;
  options.pattern = FLAGS_pattern;
  options.push_pattern = FLAGS_push_pattern;
  options.manifest_path = FLAGS_out;
  options.mass_kg = FLAGS_mass;
  options.fps = FLAGS_fps;
  options.setting = FLAGS_setting;
  options.mapping = FLAGS_mapping;
  options.up = FLAGS_up;
  options.forward = FLAGS_forward;
  options.set = SplitList(FLAGS_set, ';');
  if (!FLAGS_masses.empty()) options.people = OrFail(ReadPeople(FLAGS_masses));
  OrFail(ParseName("--push_kind", FLAGS_push_kind, &options.push_kind));
  options.length = OrFail(ChooseLength("--", FLAGS_length_unit, FLAGS_length_scale));
  return options;
}

// Throws where --out would replace a file that the patterns find, which no flag names.
void CheckFilesKept(const Manifest& manifest, const std::string& path) {
  for (const ManifestRecording& recording : manifest.recordings) {
    std::vector<std::string> files = recording.motion;
    files.push_back(recording.push_csv);
    for (const std::string& file : files) {
      if (file.empty()) continue;
      OrFail(CheckNotRead("--folder", ResolvePath(path, file)));
    }
  }
}

// The manifest that is there, with the folder's new recordings behind its entries, which stay as
// somebody may have edited them.
Manifest Updated(const std::string& path, const std::vector<ManifestRecording>& found) {
  std::error_code ignored;
  Manifest manifest;
  if (std::filesystem::exists(path, ignored)) manifest = OrFail(ReadManifest(path));
  std::set<std::string> known, in_folder;
  for (const ManifestRecording& entry : manifest.recordings) known.insert(entry.id);
  std::vector<std::string> added, gone;
  for (const ManifestRecording& entry : found) {
    in_folder.insert(entry.id);
    if (known.count(entry.id) > 0) continue;
    added.push_back(entry.id);
    manifest.recordings.push_back(entry);
  }
  for (const std::string& id : known) {
    if (in_folder.count(id) == 0) gone.push_back(id);
  }
  std::printf("%zu recordings kept as they were, %zu added\n", known.size(), added.size());
  if (!added.empty()) std::printf("added: %s\n", ListOfNames(added).c_str());
  if (!gone.empty()) {
    std::printf("kept, although they do not match the pattern: %s\n", ListOfNames(gone).c_str());
  }
  return manifest;
}

int Run() {
  const ManifestOptions options = OptionsFromFlags();
  const std::string& path = FLAGS_out;
  const MadeManifest made = OrFail(MakeManifest(options));
  Manifest manifest = made.manifest;
  CheckFilesKept(manifest, path);
  if (FLAGS_update) manifest = Updated(path, manifest.recordings);
  OrFail(WriteManifest(path, manifest));
  for (const std::string& warning : made.warnings) LOG(WARNING) << warning;
  for (const Error& error : made.unreadable) LOG(WARNING) << "left out: " << error.ToString();
  for (const std::string& id : made.without_push)
    LOG(WARNING) << "recording " << id << " has no push";
  std::printf("%zu recordings from %d files (%d others in the folder) written to %s\n",
              manifest.recordings.size(), made.files, made.others, path.c_str());
  std::printf("check them with: pushid-inspect %s\n", ShellQuoted(path).c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::JoinRepeated("set", ';', argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-manifest writes the manifest of recordings whose file names follow a pattern.\n"
      "  pushid-manifest --folder=recordings --pattern='bvh/{subject}_{take}_{magnitude}.bvh' "
      "--mass=75 --out=mine.json",
      Run);
}
