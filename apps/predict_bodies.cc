// apps: bodies of a prediction to files.
#include "apps/predict_bodies.h"

#include <cstdio>

#include "apps/support/app_support.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_files.h"

namespace pushid {
namespace {

Result<std::vector<std::string>> WriteScene(const PredictFlags& flags, const BodyScene& scene,
                                            const BodyRecording& recording,
                                            const Prediction& prediction) {
  std::vector<std::string> files = {flags.out};
  if (flags.out_is_bodies()) {
    const Result<std::vector<std::string>> written = WriteBodyFiles(flags.out, scene);
    if (!written.ok()) return written;
    files = written.value();
  } else if (MaybeError error = WriteTrajectoryCsv(flags.out, recording.pendulum, prediction)) {
    return *error;
  }
  if (!flags.joints_out.empty()) {
    if (MaybeError error = WriteJointsCsv(flags.joints_out, scene)) return *error;
    files.push_back(flags.joints_out);
  }
  if (!flags.json_out.empty()) {
    if (MaybeError error = WriteJson(flags.json_out, ToJson(scene), -1)) return *error;
    files.push_back(flags.json_out);
  }
  return files;
}

}  // namespace

int WriteBodies(const PredictFlags& flags, const Recording& recorded, SkeletonMapping mapping,
                const Prediction& prediction) {
  const Result<std::unique_ptr<Restoration>> restoration = LoadFlaggedRestoration(
      flags.restoration, prediction.rod_moves, static_cast<int>(recorded.people.size()));
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<BodyRecording> recording = MakeBodyRecording(recorded, mapping);
  if (!recording.ok()) return Fail(recording.error());
  std::vector<BodyMotion> bodies =
      RestoreBodies(*restoration.value(), flags.restoration.postprocess,
                    PredictedPeople(recording.value(), prediction));
  BodyScore score;
  if (flags.whole_recording()) score = ScoreBodies(recording.value(), bodies);
  const BodyScene scene = SceneOf(recording.value(), std::move(bodies));
  const Result<std::vector<std::string>> files =
      WriteScene(flags, scene, recording.value(), prediction);
  if (!files.ok()) return Fail(files.error());
  std::printf("%s: %d frames of %d %s predicted (%s)\n", scene.id.c_str(), scene.num_frames(),
              scene.num_people(), scene.num_people() == 1 ? "body" : "bodies",
              std::string(restoration.value()->kind()).c_str());
  for (const std::string& file : files.value()) std::printf("  %s\n", file.c_str());
  if (flags.whole_recording()) {
    std::printf("against the recording: %s\n", MetricsText(score.value, 3).c_str());
  }
  return kDone;
}

}  // namespace pushid
