// apps: pushid-simulate: synthetic recordings of people with known parameters.
#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/manifest/recording.h"
#include "ident/figures/text_table.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/model_rollout.h"

DEFINE_string(out, "", "folder to write: manifest.json, bvh/ and push/");
DEFINE_int32(people, pushid::SyntheticOptions{}.subjects,
             "number of people, of random mass and size");
DEFINE_int32(group_size, pushid::SyntheticOptions{}.people_in_row,
             "people of each recording: more than one stand in a row one behind the other, touch, "
             "and the last is pushed (fit them with --preset=group)");
DEFINE_int32(recordings_per_person, pushid::SyntheticOptions{}.recordings_per_subject,
             "pushes per person: weak, medium and strong in turn");
DEFINE_int32(frames, pushid::SyntheticOptions{}.frames, "frames of each recording");
DEFINE_double(fps, pushid::SyntheticOptions{}.fps, "frames per second");
// The library's recordings are exact; a user's trial should be as noisy as real ones.
DEFINE_double(noise, 0.002, "standard deviation of the joints' positions, m");
DEFINE_string(push_kind, pushid::NameOf(pushid::SyntheticOptions{}.push_kind),
              "net (only the push's first part, the tail follows) or external");
DEFINE_string(stance, pushid::NameOf(pushid::SyntheticOptions{}.model.stance),
              "without --model: behaviour of the synthetic people's feet: slide, steps "
              "(hold, then step) or fixed (hold)");
DEFINE_string(
    delay, pushid::NameOf(pushid::SyntheticOptions{}.model.delay),
    "without --model: reaction delay of the synthetic people: none, one or ankle_and_step "
    "(--set=reaction_delay=0.13)");
DEFINE_string(truth_noise, pushid::NameOf(pushid::SyntheticOptions{}.model.process_noise),
              "without --model: process noise of the synthetic people: none or diagonal "
              "(--set=sigma_x=...)");
DEFINE_double(
    subject_spread, pushid::SyntheticOptions{}.subject_spread,
    "variation of all parameters between people (standard deviation of the logarithm; 0.1 is "
    "about 10 %)");
DEFINE_uint64(seed, pushid::SyntheticOptions{}.seed, "seed of people, pushes and noise");

namespace {

using namespace pushid;

// The options of the study without the true parameters.
SyntheticOptions StudyFromCommandLine() {
  Require("out", FLAGS_out, "name the folder to write");
  OrFail(CheckOutputFolder("out", FLAGS_out));
  if (!FLAGS_model.empty()) {
    RefuseGiven({"stance", "delay", "truth_noise"},
                "--model sets the parameters of the people; leave --{} out");
  }
  SyntheticOptions study;
  TakeInRange("people", FLAGS_people, 1, 10000, &study.subjects);
  TakeInRange("recordings_per_person", FLAGS_recordings_per_person, 1, 10000,
              &study.recordings_per_subject);
  TakeInRange("group_size", FLAGS_group_size, 1, std::min(FLAGS_people, 100), &study.people_in_row);
  TakeInRange("frames", FLAGS_frames, 3, 100000, &study.frames);
  TakeInRange("fps", FLAGS_fps, 10, 10000, &study.fps);
  TakeInRange("noise", FLAGS_noise, 0, 0.1, &study.joint_noise_m);
  TakeInRange("subject_spread", FLAGS_subject_spread, 0, 2, &study.subject_spread);
  const std::optional<PushKind> kind = FromName<PushKind>(FLAGS_push_kind);
  if (!kind || *kind == PushKind::kNetWithoutFriction) {
    throw Error{"--push_kind is '" + FLAGS_push_kind + "'; it must be net or external"};
  }
  OrFail(ParseName("--stance", FLAGS_stance, &study.model.stance));
  OrFail(ParseName("--delay", FLAGS_delay, &study.model.delay));
  OrFail(ParseName("--truth_noise", FLAGS_truth_noise, &study.model.process_noise));
  study.push_kind = *kind;
  study.seed = FLAGS_seed;
  return study;
}

void PrintTruth(const IdentifiedModel& truth, const SyntheticOptions& options) {
  TextTable table({"parameter", ">truth", "unit"});
  for (const ParameterSpec& spec : truth.table.specs) {
    const double value = truth.parameters[spec.id];
    const bool noise =
        IsNoiseParameter(spec.id) && !IsMeasurementError(spec.id) && Acts(spec.id, truth.options);
    if (spec.free || noise || value != spec.nominal)
      table.Add({spec.name, Rounded(value, 4), spec.unit});
  }
  std::printf("%s", table.ToString().c_str());
  if (options.subject_spread > 0.0) {
    std::printf("(the centre: every parameter varies about it by %s between people)\n",
                Rounded(options.subject_spread, 3).c_str());
  }
}

std::string ManifestFile() { return (std::filesystem::path(FLAGS_out) / "manifest.json").string(); }

int Run() {
  SyntheticOptions study = StudyFromCommandLine();
  const IdentifiedModel truth =
      FLAGS_model.empty() ? OrFail(SyntheticTruth(study, FLAGS_set)) : LoadFlaggedModel();
  study.model = truth.options;
  study.parameters = truth.parameters;
  if (study.people_in_row > 1 && !study.model.interaction.Any()) {
    LOG(WARNING)
        << "the people of --model do not act on each other: only the pushed one of a group moves";
  }
  const std::vector<SyntheticRecording> made = OrFail(MakeSyntheticRecordings(study));
  for (const std::string& warning :
       ExtrapolationWarnings(truth, MakePendulumRecordings(Recordings(made)))) {
    LOG(WARNING) << warning;
  }
  OrFail(WriteSyntheticRecordings(FLAGS_out, study, made));
  PrintTruth(truth, study);
  const std::string groups =
      study.people_in_row > 1 ? " in rows of " + std::to_string(study.people_in_row) : "";
  std::printf("%zu recordings of %d people%s, joint noise %s mm: %s lists the BVH and push files\n",
              made.size(), study.subjects, groups.c_str(),
              Rounded(1000.0 * study.joint_noise_m, 3).c_str(), ManifestFile().c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-simulate makes recordings of synthetic people with known "
                        "parameters, alone or in groups.\n"
                        "  pushid-simulate --out=synthetic --people=4 --seed=1",
                        Run);
}
