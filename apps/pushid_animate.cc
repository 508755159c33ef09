// apps: pushid-animate: recorded and predicted people as a web page and as a strip of poses.
#include <gflags/gflags.h>

#include <cstdio>

#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/prediction/prediction.h"
#include "models/self_network.h"

DEFINE_string(id, "", "the recording to show");
DEFINE_string(out, "", "the page to write (HTML), for any browser");
DEFINE_string(strip_out, "", "a strip of poses (SVG)");
DEFINE_int32(poses, 7, "poses of the strip");
DEFINE_bool(recorded, true, "show the recorded bodies too");

namespace {

using namespace pushid;

MaybeError CheckFlags() {
  if (MaybeError missing = Require("id", FLAGS_id, "name a recording of the manifest")) {
    return missing;
  }
  if (FLAGS_out.empty() && FLAGS_strip_out.empty()) {
    return Error{"--out and --strip_out are missing: name a page (HTML) or a picture (SVG)"};
  }
  if (FLAGS_poses < 2 || FLAGS_poses > 40) return Error{"--poses must lie between 2 and 40"};
  for (const std::string& file : {FLAGS_out, FLAGS_strip_out}) {
    if (file.empty()) continue;
    if (MaybeError error = CheckWritable(file)) return error;
  }
  return std::nullopt;
}

int Run() {
  if (MaybeError error = CheckFlags()) return Fail(*error);
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (FLAGS_restoration.empty()) FLAGS_restoration = "rigid";
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(RodMoves(model.value().options));
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<PostprocessOptions> postprocess = PostprocessOfFlags();
  if (!postprocess.ok()) return Fail(postprocess.error());
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({FLAGS_id}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  const Result<BodyRecording> recording =
      MakeBodyRecording(recordings.value().front(), model.value().mapping);
  if (!recording.ok()) return Fail(recording.error());

  const PendulumRecording& pendulum = recording.value().pendulum;
  const Prediction prediction = Predict(model.value(), pendulum);
  if (!prediction.status.ok) {
    std::fprintf(stderr, "pushid-animate: %s of person %d leaves the model's domain at frame %d\n",
                 std::string(prediction.status.quantity).c_str(), prediction.status.person,
                 prediction.status.frame);
    return kFitFailed;
  }
  Animation animation;
  animation.title = pendulum.id + ", " + std::string(restoration.value()->kind());
  animation.dt = pendulum.scene.dt;
  if (FLAGS_recorded) AddRecorded(pendulum.subject_ids, recording.value().bodies, &animation);
  AddPrediction(pendulum, prediction,
                RestoreBodies(*restoration.value(), postprocess.value(),
                              PredictedPeople(recording.value(), prediction.path)),
                &animation);
  if (!FLAGS_out.empty()) {
    if (MaybeError error = WriteFileAtomically(FLAGS_out, AnimationHtml(animation))) {
      return Fail(*error);
    }
    std::printf("%s\n", FLAGS_out.c_str());
  }
  if (!FLAGS_strip_out.empty()) {
    const std::string svg = PoseStripSvg(animation, FLAGS_poses);
    if (MaybeError error = WriteFileAtomically(FLAGS_strip_out, svg)) return Fail(*error);
    std::printf("%s\n", FLAGS_strip_out.c_str());
  }
  return kDone;
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
