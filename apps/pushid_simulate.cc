// apps: pushid-simulate: synthetic recordings of people with known parameters; with --formation, a
// model on people who stand together.
#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>

#include "apps/flags/formation_bodies_flags.h"
#include "apps/flags/formation_flags.h"
#include "apps/flags/model_flags.h"
#include "apps/simulate_formation.h"
#include "apps/support/app_support.h"
#include "apps/support/output_folder.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/recording_names.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/figures/text_table.h"

DECLARE_string(set);

DEFINE_string(out, "", "folder to write: manifest.json, bvh/ and push/");
DEFINE_int32(people, 4, "how many people: of random mass and size, or in the formation");
DEFINE_int32(recordings_per_person, 6, "pushes of each person: weak, medium and strong in turn");
DEFINE_int32(frames, 90, "frames of each recording");
DEFINE_double(fps, 60.0, "frames a second");
DEFINE_double(noise, 0.002, "standard deviation of the joints' positions, m");
DEFINE_string(push_kind, "net", "net (only the push's first part, the tail follows) or external");
DEFINE_double(recording_spread, 0.0,
              "how much all parameters vary between recordings (standard deviation of the "
              "logarithm; 0.1 is about 10 %)");
DEFINE_double(subject_spread, 0.0, "the same between people");
DEFINE_uint64(seed, 1, "seed of people, pushes and noise");

namespace {

using namespace pushid;

// The model of --model, else the tail preset: what it fits has the values identified from the
// published recordings, what it holds keeps its value, so that a fit can find the truth exactly.
// Either with --set.
Result<IdentifiedModel> Truth() {
  if (!FLAGS_model.empty()) return LoadFlaggedModel();
  const FitOptions preset = MakePreset("tail").value();
  IdentifiedModel model;
  model.options = preset.model;
  model.table = preset.table;
  model.parameters = preset.table.Values();
  for (Parameter id : preset.table.Free()) model.parameters[id] = PublishedTailParameters()[id];
  if (MaybeError error = SetValues(FLAGS_set, &model)) return *error;
  return model;
}

// The library checks them too, but knows no flags.
MaybeError CheckNumbers() {
  for (MaybeError error :
       {CheckRange("people", FLAGS_people, 1, 10000),
        CheckRange("recordings_per_person", FLAGS_recordings_per_person, 1, 10000),
        CheckRange("frames", FLAGS_frames, 3, 100000), CheckRange("fps", FLAGS_fps, 10, 10000),
        CheckRange("noise", FLAGS_noise, 0, 0.1),
        CheckRange("recording_spread", FLAGS_recording_spread, 0, 2),
        CheckRange("subject_spread", FLAGS_subject_spread, 0, 2)}) {
    if (error) return error;
  }
  return std::nullopt;
}

void PrintTruth(const IdentifiedModel& truth) {
  TextTable table({"parameter", "truth", "unit"}, {true, false, true});
  for (const ParameterSpec& spec : truth.table.specs) {
    const double value = truth.parameters[spec.id];
    if (spec.free || value != spec.nominal) table.Add({spec.name, Rounded(value, 4), spec.unit});
  }
  std::printf("%s", table.ToString().c_str());
  if (FLAGS_recording_spread > 0.0 || FLAGS_subject_spread > 0.0) {
    std::printf(
        "(the centre: every parameter varies about it by %s between recordings, %s "
        "between people)\n",
        Rounded(FLAGS_recording_spread, 3).c_str(), Rounded(FLAGS_subject_spread, 3).c_str());
  }
}

int Run() {
  if (!FLAGS_formation.empty()) return SimulateFormation();
  const char* flag = GivenFormationFlag() != nullptr ? GivenFormationFlag() : GivenBodyFlag();
  if (flag != nullptr) {
    return Fail(std::string("--") + flag + " needs --formation: line, diamond or grid");
  }
  if (MaybeError missing = Require("out", FLAGS_out, "name the folder to write")) {
    return Fail(*missing);
  }
  if (MaybeError error = CheckOutputFolder("out", FLAGS_out)) return Fail(*error);
  if (MaybeError error = CheckNumbers()) return Fail(*error);
  const Result<IdentifiedModel> truth = Truth();
  if (!truth.ok()) return Fail(truth.error());
  const std::optional<PushKind> kind = PushKindFromName(FLAGS_push_kind);
  if (!kind || *kind == PushKind::kNetWithoutFriction) {
    return Fail("--push_kind is '" + FLAGS_push_kind + "'; it must be net or external");
  }
  SyntheticOptions options;
  options.model = truth.value().options;
  options.parameters = truth.value().parameters;
  options.subjects = FLAGS_people;
  options.recordings_per_subject = FLAGS_recordings_per_person;
  options.frames = FLAGS_frames;
  options.fps = FLAGS_fps;
  options.joint_noise_m = FLAGS_noise;
  options.push_kind = *kind;
  options.recording_spread = FLAGS_recording_spread;
  options.subject_spread = FLAGS_subject_spread;
  options.seed = FLAGS_seed;
  const Result<std::vector<SyntheticRecording>> made = MakeSyntheticRecordings(options);
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = WriteSyntheticRecordings(FLAGS_out, options, made.value())) {
    return Fail(*error);
  }
  PrintTruth(truth.value());
  std::printf(
      "%zu recordings of %d people, joints noisy by %s mm: %s names the BVH and push files\n",
      made.value().size(), FLAGS_people, Rounded(1000.0 * FLAGS_noise, 3).c_str(),
      (std::filesystem::path(FLAGS_out) / "manifest.json").c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-simulate makes recordings of synthetic people whose parameters are "
                        "known,\nor rolls an identified model out on a formation.\n\n"
                        "  pushid-simulate --out=synthetic --people=4 --seed=1\n"
                        "  pushid-simulate --model=model.json --formation=line --people=10 "
                        "--push=80 --svg_out=wave.svg",
                        Run);
}
