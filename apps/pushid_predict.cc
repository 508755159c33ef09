// apps: pushid-predict: what happens after a push, from the first frame and the push alone.
#include <cstdio>

#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/predict_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/predict_bodies.h"
#include "apps/support/grouped_warnings.h"
#include "datasets/files/number_text.h"
#include "ident/fit/model_rollout.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"

namespace {

using namespace pushid;

int WritePendulums(const PredictFlags& flags, const PendulumRecording& recording,
                   const Prediction& prediction) {
  if (MaybeError error = WriteTrajectoryCsv(flags.out, recording, prediction)) {
    return Fail(*error);
  }
  std::printf("%s: %d frames predicted, written to %s\n", recording.id.c_str(),
              prediction.path.num_frames(), flags.out.c_str());
  if (flags.whole_recording()) {
    const RecordingScore score = ScoreHip(recording, prediction.hip, prediction.observed);
    std::printf("against the recording: %s\n", MetricsText(score, 3, prediction.observed).c_str());
  }
  return kDone;
}

int Run() {
  const Result<PredictFlags> read = PredictFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const PredictFlags& flags = read.value();
  const Result<FuturesFlags> futures = FuturesFlagsFromCommandLine(true);
  if (!futures.ok()) return Fail(futures.error());
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (MaybeError error = CheckDraws(futures.value(), model.value())) return Fail(*error);
  const Result<std::vector<Recording>> recordings =
      LoadFlaggedRecordings({flags.id}, flags.restoration.given());
  if (!recordings.ok()) return Fail(recordings.error());
  const PendulumRecording recording =
      MakePendulumRecording(recordings.value().front(), model.value().mapping);

  WarnGrouped(InputWarnings(model.value(), {recording}));
  if (MaybeError error = CheckObservedFlag({recording}, model.value())) return Fail(*error);
  if (!flags.whole_recording() && flags.frames <= ObservedFrames()) {
    return Fail("--frames=" + std::to_string(flags.frames) + " leaves none to predict after " +
                "--observed=" + std::to_string(ObservedFrames()) + "; it must be larger");
  }
  const Result<Prediction> predicted =
      PredictFrom(model.value(), recording, ObservedFrames(), flags.frames);
  if (!predicted.ok()) return Fail(predicted.error());
  const Prediction& prediction = predicted.value();
  if (!prediction.status.ok) {
    std::fprintf(stderr, "pushid-predict: recording %s: %s\n", recording.id.c_str(),
                 OutsideText(prediction.status).c_str());
    return kFitFailed;
  }
  const int code = flags.restoration.given() ? WriteBodies(flags, recordings.value().front(),
                                                           model.value().mapping, prediction)
                                             : WritePendulums(flags, recording, prediction);
  if (code != kDone) return code;
  std::printf("%s%s", PredictedStepsText(recording, prediction).c_str(),
              EffectText(prediction).c_str());
  return PrintFutures(futures.value(), model.value(), recording, flags.frames);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-predict rolls a model out from a recording's first frame and push.\n\n"
      "  pushid-predict --model=model.json --recordings=M/manifest.json "
      "--id=NAME --out=trajectory.csv\n  pushid-predict --model=model.json "
      "--restoration=restoration --recordings=M/manifest.json --id=NAME --out=motion.bvh",
      Run);
}
