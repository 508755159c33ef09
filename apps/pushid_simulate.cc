// apps: pushid-simulate: synthetic recordings of people with known parameters.
#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>

#include "apps/app_support.h"
#include "apps/model_flags.h"
#include "datasets/recording_names.h"
#include "datasets/synthetic_recordings.h"
#include "ident/report_text.h"
#include "ident/text_table.h"

DECLARE_string(set);

DEFINE_string(out, "", "folder to write: manifest.json, bvh/ and push/");
DEFINE_int32(people, 4, "how many people, of random mass and size");
DEFINE_int32(recordings_per_person, 6, "pushes of each person: weak, medium and strong in turn");
DEFINE_int32(frames, 90, "frames of each recording");
DEFINE_double(fps, 60.0, "frames a second");
DEFINE_double(noise, 0.002, "standard deviation of the joints' positions, m");
DEFINE_string(push_kind, "net", "net (only the push's first part, the tail follows) or external");
DEFINE_double(
    spread, 0.0,
    "how much people's gains vary between recordings (standard deviation of the logarithm)");
DEFINE_uint64(seed, 1, "seed of people, pushes and noise");

namespace {

using namespace pushid;

// The model of --model, else the tail model with the values identified from the published
// recordings; either with --set.
Result<IdentifiedModel> Truth() {
  if (!FLAGS_model.empty()) return LoadFlaggedModel();
  const Preset preset = MakePreset("tail").value();
  IdentifiedModel model;
  model.options = preset.model;
  model.table = preset.table;
  model.parameters = PublishedTailParameters();
  if (MaybeError error = SetValues(FLAGS_set, &model)) return *error;
  return model;
}

void PrintTruth(const IdentifiedModel& truth) {
  TextTable table({"parameter", "truth", "unit"}, {true, false, true});
  for (const ParameterSpec& spec : truth.table.specs) {
    if (spec.free) table.Add({spec.name, Significant(truth.parameters[spec.id]), spec.unit});
  }
  std::printf("%s", table.ToString().c_str());
}

int Run() {
  if (MaybeError missing = Require("out", FLAGS_out, "name the folder to write")) {
    return Fail(*missing);
  }
  std::error_code ignored;
  if (std::filesystem::exists(FLAGS_out, ignored) &&
      !std::filesystem::is_directory(FLAGS_out, ignored)) {
    return Fail("--out names " + FLAGS_out + ", which is a file; name a folder");
  }
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
  options.recording_spread = FLAGS_spread;
  options.seed = FLAGS_seed;
  const Result<std::vector<SyntheticRecording>> made = MakeSyntheticRecordings(options);
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = WriteSyntheticRecordings(FLAGS_out, options, made.value())) {
    return Fail(*error);
  }
  PrintTruth(truth.value());
  std::printf("%zu recordings of %d people, joints noisy by %s mm, written to %s\n",
              made.value().size(), FLAGS_people, Significant(1000.0 * FLAGS_noise, 3).c_str(),
              (std::filesystem::path(FLAGS_out) / "manifest.json").c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-simulate makes recordings of synthetic people whose parameters are "
                        "known.\n\n  pushid-simulate --out=synthetic --people=4 --seed=1",
                        Run);
}
