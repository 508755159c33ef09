// apps: pushid-animate: recorded and predicted people as a web page and as a strip of poses.
#include <algorithm>
#include <cstdio>

#include "apps/flags/animate_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/what_if_flags.h"
#include "apps/support/grouped_warnings.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/prediction/prediction.h"
#include "models/learned_terms.h"

namespace {

using namespace pushid;

MaybeError Write(const std::string& file, const std::string& content) {
  if (MaybeError error = WriteFileAtomically(file, content)) return error;
  std::printf("%s\n", file.c_str());
  return std::nullopt;
}

// Of the model as it was fitted.
MaybeError Explain(const std::string& who, const PendulumRecording& recording,
                   const Prediction& prediction, Animation* animation) {
  ForceStory story;
  if (who == "auto") {
    story = RichestStory(recording, prediction);
    if (story.person < 0) story = StoryOf(recording, prediction, recording.pushed_person);
  } else {
    const auto found = std::find(recording.subject_ids.begin(), recording.subject_ids.end(), who);
    if (found == recording.subject_ids.end()) {
      return Error{"--explain names '" + who + "', who is not in recording " + recording.id +
                   "; there are " + ListOfNames(recording.subject_ids)};
    }
    story = StoryOf(recording, prediction, static_cast<int>(found - recording.subject_ids.begin()));
  }
  std::printf("%s\n", StoryText(recording, story).c_str());
  animation->story = AnimatedStory{recording.subject_ids[story.person], std::move(story)};
  return std::nullopt;
}

int LeftDomain(const RolloutStatus& status, const std::string& what) {
  std::fprintf(stderr, "pushid-animate: %s%s of person %d leaves the model's domain at frame %d\n",
               what.empty() ? "" : ("with " + what + " ").c_str(),
               std::string(status.quantity).c_str(), status.person, status.frame);
  return kFitFailed;
}

int Run() {
  const Result<AnimateFlags> read = AnimateFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const AnimateFlags& flags = read.value();
  const Result<std::vector<WhatIf>> what_ifs = LoadWhatIfs();
  if (!what_ifs.ok()) return Fail(what_ifs.error());
  const IdentifiedModel& model = what_ifs.value().front().model;
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({flags.id}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(flags.restoration, RodMoves(model.options),
                             static_cast<int>(recordings.value().front().people.size()));
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<BodyRecording> recording =
      MakeBodyRecording(recordings.value().front(), model.mapping);
  if (!recording.ok() && flags.bodies_asked) return Fail(recording.error());
  if (!recording.ok()) Warn(recording.error().ToString() + "; only pendulums are shown");

  const PendulumRecording pendulum =
      MakePendulumRecording(recordings.value().front(), model.mapping);
  WarnGrouped(InputWarnings(model, {pendulum}));
  Animation animation;
  animation.title = pendulum.id;
  animation.dt = pendulum.scene.dt;
  AddPushes(pendulum, &animation);
  if (recording.ok()) animation.title += ", " + std::string(restoration.value()->kind());
  if (recording.ok() && flags.recorded) {
    AddRecorded(pendulum.subject_ids, recording.value().bodies, &animation);
  }
  for (const WhatIf& one : what_ifs.value()) {
    const Prediction prediction = Predict(one.model, pendulum);
    if (!prediction.status.ok) return LeftDomain(prediction.status, one.what);
    if (!flags.explain.empty() && !animation.story) {
      const MaybeError unknown = Explain(flags.explain, pendulum, prediction, &animation);
      if (unknown) return Fail(*unknown);
    }
    std::vector<BodyMotion> bodies;
    if (recording.ok()) {
      bodies = RestoreBodies(*restoration.value(), flags.restoration.postprocess,
                             PredictedPeople(recording.value(), prediction));
    }
    AddPrediction(pendulum, prediction, bodies, &animation, one.what);
  }
  MaybeError error;
  if (!flags.out.empty()) error = Write(flags.out, AnimationHtml(animation));
  if (!error && !flags.strip_out.empty()) {
    error = Write(flags.strip_out, PoseStripSvg(animation, flags.poses));
  }
  return error ? Fail(*error) : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::JoinRepeated("set", pushid::kBetweenSets, argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-animate shows recorded and predicted people, pendulums and net forces.\n\n"
      "  pushid-animate --model=model.json --restoration=restoration --recordings=M/manifest.json "
      "--id=NAME --out=motion.html --strip_out=poses.svg\n\n"
      "Several what-ifs are shown over the fitted model: --set=mu=10 --set=mu=60",
      Run);
}
