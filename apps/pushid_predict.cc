// apps: pushid-predict: what happens after a push, from the first frame and the push alone.
#include <gflags/gflags.h>

#include <cstdio>

#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "apps/predict_bodies.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/prediction/evaluation.h"

DEFINE_string(id, "", "the recording whose first frame and push are taken");
DEFINE_string(out, "",
              "write the trajectory here (CSV: states, hip, forces by part); with --restoration "
              "and a name that ends with .bvh, the bodies (BVH, one file a person)");
DEFINE_int32(frames, 0, "frames to predict; 0: as many as the recording has");

namespace {

constexpr int kMostFrames = 1000000;  // hours of motion

int Run() {
  using namespace pushid;
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (MaybeError missing = Require("id", FLAGS_id, "name a recording of the manifest")) {
    return Fail(*missing);
  }
  if (MaybeError missing = Require("out", FLAGS_out, "name the CSV or BVH file to write")) {
    return Fail(*missing);
  }
  if (MaybeError error = CheckBodyFlags(FLAGS_out)) return Fail(*error);
  if (FLAGS_frames != 0 && (FLAGS_frames < 2 || FLAGS_frames > kMostFrames)) {
    return Fail("--frames must be 0, or lie between 2 and " + std::to_string(kMostFrames));
  }
  if (MaybeError error = CheckWritable(FLAGS_out)) return Fail(*error);
  const Result<std::vector<Recording>> recordings =
      LoadFlaggedRecordings({FLAGS_id}, !FLAGS_restoration.empty());
  if (!recordings.ok()) return Fail(recordings.error());
  const PendulumRecording recording =
      MakePendulumRecording(recordings.value().front(), model.value().mapping);

  const Prediction prediction = Predict(model.value(), recording, FLAGS_frames);
  if (!prediction.status.ok) {
    std::fprintf(stderr,
                 "pushid-predict: recording %s: %s of person %d leaves the model's domain at "
                 "frame %d\n",
                 recording.id.c_str(), std::string(prediction.status.quantity).c_str(),
                 prediction.status.person, prediction.status.frame);
    return kFitFailed;
  }
  if (!FLAGS_restoration.empty()) {
    return WriteBodies(recordings.value().front(), model.value().mapping, prediction, FLAGS_out,
                       FLAGS_frames == 0);
  }
  if (MaybeError error = WriteTrajectoryCsv(FLAGS_out, recording, prediction)) {
    return Fail(*error);
  }
  std::printf("%s: %d frames predicted, written to %s\n", recording.id.c_str(),
              prediction.path.num_frames(), FLAGS_out.c_str());
  if (FLAGS_frames == 0) {
    const RecordingScore score = ScoreHip(recording, prediction.hip);
    std::printf("against the recording: %s\n", MetricsText(score, 3).c_str());
  }
  return kDone;
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
