// apps: pushid-animate: recorded and predicted people as a web page and as a strip of poses.
#include <cstdio>

#include "apps/flags/animate_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/prediction/prediction.h"
#include "models/self_network.h"

namespace {

using namespace pushid;

MaybeError Write(const std::string& file, const std::string& content) {
  if (MaybeError error = WriteFileAtomically(file, content)) return error;
  std::printf("%s\n", file.c_str());
  return std::nullopt;
}

int Run() {
  const Result<AnimateFlags> read = AnimateFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const AnimateFlags& flags = read.value();
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(flags.restoration, RodMoves(model.value().options));
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({flags.id}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  const Result<BodyRecording> recording =
      MakeBodyRecording(recordings.value().front(), model.value().mapping);
  if (!recording.ok() && flags.bodies_asked) return Fail(recording.error());
  if (!recording.ok()) Warn(recording.error().ToString() + "; pendulums alone are shown");

  const PendulumRecording pendulum =
      MakePendulumRecording(recordings.value().front(), model.value().mapping);
  const Prediction prediction = Predict(model.value(), pendulum);
  if (!prediction.status.ok) {
    std::fprintf(stderr, "pushid-animate: %s of person %d leaves the model's domain at frame %d\n",
                 std::string(prediction.status.quantity).c_str(), prediction.status.person,
                 prediction.status.frame);
    return kFitFailed;
  }
  Animation animation;
  animation.title = pendulum.id;
  animation.dt = pendulum.scene.dt;
  std::vector<BodyMotion> bodies;
  if (recording.ok()) {
    animation.title += ", " + std::string(restoration.value()->kind());
    if (flags.recorded) AddRecorded(pendulum.subject_ids, recording.value().bodies, &animation);
    bodies = RestoreBodies(*restoration.value(), flags.restoration.postprocess,
                           PredictedPeople(recording.value(), prediction));
  }
  AddPrediction(pendulum, prediction, bodies, &animation);
  MaybeError error;
  if (!flags.out.empty()) error = Write(flags.out, AnimationHtml(animation));
  if (!error && !flags.strip_out.empty()) {
    error = Write(flags.strip_out, PoseStripSvg(animation, flags.poses));
  }
  return error ? Fail(*error) : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-animate shows recorded and predicted people, pendulums and net "
                        "forces.\n\n  pushid-animate --model=model.json --restoration=restoration "
                        "--recordings=M/manifest.json --id=NAME --out=motion.html "
                        "--strip_out=poses.svg",
                        Run);
}
