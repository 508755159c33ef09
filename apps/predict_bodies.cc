// apps: bodies of a prediction to files.
#include "apps/predict_bodies.h"

#include <cstdio>

#include "apps/flags/restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_files.h"

DEFINE_string(joints_out, "",
              "--restoration: joint positions (CSV: frame, person, joint, x, y, z)");
DEFINE_string(json_out, "", "--restoration: joint positions of every person and frame (JSON)");

namespace pushid {
namespace {

bool IsBvh(const std::string& path) {
  return path.size() > 4 && path.compare(path.size() - 4, 4, ".bvh") == 0;
}

BodyScene SceneOf(const BodyRecording& recording, std::vector<BodyMotion> bodies) {
  BodyScene scene;
  scene.id = recording.pendulum.id;
  scene.dt = recording.pendulum.scene.dt;
  scene.subject_ids = recording.pendulum.subject_ids;
  scene.joint_names = recording.joint_names;
  scene.bodies = std::move(bodies);
  return scene;
}

MaybeError WriteScene(const BodyScene& scene, const BodyRecording& recording,
                      const Prediction& prediction, const std::string& out,
                      std::vector<std::string>* files) {
  if (IsBvh(out)) {
    const Result<std::vector<std::string>> written = WriteBodyBvh(out, scene);
    if (!written.ok()) return written.error();
    *files = written.value();
  } else {
    if (MaybeError error = WriteTrajectoryCsv(out, recording.pendulum, prediction)) return error;
    *files = {out};
  }
  if (!FLAGS_joints_out.empty()) {
    if (MaybeError error = WriteJointsCsv(FLAGS_joints_out, scene)) return error;
    files->push_back(FLAGS_joints_out);
  }
  if (FLAGS_json_out.empty()) return std::nullopt;
  files->push_back(FLAGS_json_out);
  return WriteJson(FLAGS_json_out, ToJson(scene), -1);
}

}  // namespace

MaybeError CheckBodyFlags(const std::string& out) {
  if (FLAGS_restoration.empty()) {
    const char* needy = !FLAGS_joints_out.empty() ? "--joints_out"
                        : !FLAGS_json_out.empty() ? "--json_out"
                        : IsBvh(out)              ? "--out=... .bvh"
                                                  : nullptr;
    if (needy == nullptr) return std::nullopt;
    return Error{std::string(needy) +
                 " needs bodies: name the folder of pushid-train-restoration by --restoration"};
  }
  for (const std::string& file : {FLAGS_joints_out, FLAGS_json_out}) {
    if (file.empty()) continue;
    if (MaybeError error = CheckWritable(file)) return error;
  }
  return std::nullopt;
}

int WriteBodies(const Recording& recorded, SkeletonMapping mapping, const Prediction& prediction,
                const std::string& out, bool compare) {
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(prediction.rod_moves);
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<PostprocessOptions> postprocess = PostprocessOfFlags();
  if (!postprocess.ok()) return Fail(postprocess.error());
  const Result<BodyRecording> recording = MakeBodyRecording(recorded, mapping);
  if (!recording.ok()) return Fail(recording.error());
  std::vector<BodyMotion> bodies =
      RestoreBodies(*restoration.value(), postprocess.value(),
                    PredictedPeople(recording.value(), prediction.path));
  BodyScore score;
  if (compare) score = ScoreBodies(recording.value(), bodies);
  std::vector<std::string> files;
  const BodyScene scene = SceneOf(recording.value(), std::move(bodies));
  if (MaybeError error = WriteScene(scene, recording.value(), prediction, out, &files)) {
    return Fail(*error);
  }
  std::printf("%s: %d frames of %d %s predicted (%s)\n", scene.id.c_str(), scene.num_frames(),
              scene.num_people(), scene.num_people() == 1 ? "body" : "bodies",
              std::string(restoration.value()->kind()).c_str());
  for (const std::string& file : files) std::printf("  %s\n", file.c_str());
  if (compare) {
    std::printf("against the recording: %s\n", MetricsText(score.value, 3).c_str());
  }
  return kDone;
}

}  // namespace pushid
