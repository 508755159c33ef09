// apps: pushid-animate: recorded and predicted people as a web page.
#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/prediction/prediction.h"
#include "ident/prediction/propagation.h"

DEFINE_string(id, "", "the recording to show");
DEFINE_string(out, "", "the page to write (HTML), for any browser");
DEFINE_string(explain, "",
              "describe the forces on this person in words, beside the motion: a person's id, or "
              "auto (the bystander with the most events)");

namespace {

using namespace pushid;

// The forces of the model as it was fitted, in words.
std::string Explained(const std::string& who, const PendulumRecording& recording,
                      const Prediction& prediction) {
  ForceStory story;
  if (who == "auto") {
    story = RichestStory(recording, prediction);
    if (story.person < 0) story = StoryOf(recording, prediction, recording.pushed_person);
  } else {
    const auto found = std::find(recording.subject_ids.begin(), recording.subject_ids.end(), who);
    if (found == recording.subject_ids.end()) {
      throw Error{"--explain names '" + who + "', who is not in recording " + recording.id +
                  "; there are " + ListOfNames(recording.subject_ids)};
    }
    story = StoryOf(recording, prediction, static_cast<int>(found - recording.subject_ids.begin()));
  }
  return StoryText(recording, story);
}

int Run() {
  Require("id", FLAGS_id, "name a recording of the manifest");
  Require("out", FLAGS_out, "name a page (HTML)");
  OrFail(CheckOutputFiles({FLAGS_out}));
  const RestorationFlags flags = RestorationFlagsFromCommandLine("rigid");
  const std::vector<WhatIf> what_ifs = LoadWhatIfs();
  const IdentifiedModel& model = what_ifs.front().model;
  const std::vector<Recording> recordings = LoadFlaggedRecordings({FLAGS_id}, true);
  const std::unique_ptr<Restoration> restoration =
      LoadFlaggedRestoration(flags, static_cast<int>(recordings.front().people.size()));
  const Result<BodyRecording> recording = MakeBodyRecording(recordings.front());
  if (!recording.ok() && Given("restoration")) return Fail(recording.error());
  if (!recording.ok()) LOG(WARNING) << recording.error().ToString() << "; only pendulums are shown";

  const PendulumRecording pendulum = MakePendulumRecording(recordings.front());
  WarnGrouped(InputWarnings(model, {pendulum}));
  Animation animation;
  animation.title = pendulum.id;
  animation.dt = pendulum.scene.dt;
  AddPushes(pendulum, &animation);
  if (recording.ok()) animation.title += ", " + std::string(restoration->kind());
  std::vector<BodyMotion> seen;
  if (recording.ok()) seen = recording.value().bodies;
  ToLaboratory(pendulum.scene, &seen);
  AddRecorded(InLaboratory(pendulum), seen, &animation);
  for (const WhatIf& one : what_ifs) {
    const Prediction prediction = Predict(one.model, pendulum);
    if (!prediction.status.ok) {
      const std::string with = one.what.empty() ? "" : "with " + one.what + " ";
      return Fail(with + OutsideText(prediction.status), kFitFailed);
    }
    if (!FLAGS_explain.empty() && animation.told.empty()) {
      animation.told = Explained(FLAGS_explain, pendulum, prediction);
      std::printf("%s\n", animation.told.c_str());
    }
    std::vector<BodyMotion> bodies;
    if (recording.ok()) {
      bodies = RestoreBodies(*restoration, flags.postprocess,
                             PredictedPeople(recording.value(), prediction));
    }
    ToLaboratory(pendulum.scene, &bodies);
    AddPrediction(InLaboratory(pendulum), InLaboratory(pendulum, prediction), bodies, &animation,
                  one.what);
  }
  OrFail(WriteFileAtomically(FLAGS_out, AnimationHtml({animation})));
  std::printf("%s\n", FLAGS_out.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::JoinRepeated("set", pushid::kBetweenSets, argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-animate shows recorded and predicted people, pendulums and forces as a web page.\n"
      "  pushid-animate --model=model.json --recordings=held-out/manifest.json --id=S01_00_weak "
      "--out=motion.html",
      Run);
}
