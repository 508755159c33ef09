// apps: groups forecast and shown.
#include "apps/generate_groups.h"

#include "datasets/files/atomic_file.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_files.h"
#include "ident/prediction/online_predictor.h"
#include "ident/results/model_rollout.h"
#include "ident/results/result_json.h"

namespace pushid {
namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// From the frames that the generator is shown too (one is the first, which everybody has), but from
// frame 0 where physics go into the network, as in its training.
Result<Prediction> PredictBeside(const LoadedGenerator& loaded, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames) {
  const bool shows = loaded.settings.observed > 1 && !loaded.settings.pendulum;
  const int observed = shows ? loaded.settings.observed : 0;
  Result<Prediction> predicted = PredictFrom(physics, recording.pendulum, observed, frames);
  if (!predicted.ok() || predicted.value().status.ok) return predicted;
  return Error{"recording " + recording.pendulum.id + ": " + OutsideText(predicted.value().status) +
                   "; leave out --physics",
               physics.source};
}

BodyScene SceneOf(const BodyRecording& recording, const std::vector<BodyMotion>& bodies) {
  BodyScene scene;
  scene.id = recording.pendulum.id;
  scene.dt = recording.pendulum.scene.dt;
  scene.subject_ids = recording.pendulum.subject_ids;
  scene.joint_names = recording.joint_names;
  scene.bodies = bodies;
  return scene;
}

Result<std::vector<std::string>> WriteGroup(const std::string& path, const BodyScene& scene) {
  if (EndsWith(path, ".bvh")) return WriteBodyBvh(path, scene);
  if (MaybeError error = WriteJointsCsv(path, scene)) return *error;
  return std::vector<std::string>{path};
}

}  // namespace

Result<std::optional<IdentifiedModel>> LoadPhysics(const std::string& file) {
  if (file.empty()) return std::optional<IdentifiedModel>();
  const Result<FittedModel> read = ReadFittedModel(file);
  if (!read.ok()) return read.error();
  IdentifiedModel model = ModelOf(read.value().fit);
  model.source = file;
  return std::optional<IdentifiedModel>(std::move(model));
}

Result<std::vector<BodyMotion>> GenerateWith(const LoadedGenerator& loaded,
                                             const BodyRecording& recording,
                                             const std::optional<IdentifiedModel>& physics,
                                             int frames) {
  GroupHips hips;
  if (physics) {
    const Result<Prediction> predicted = PredictBeside(loaded, *physics, recording, frames);
    if (!predicted.ok()) return predicted.error();
    hips = PendulumHips(recording, predicted.value().path);
  }
  return GenerateBodies(loaded.settings, *loaded.generator, recording, hips, frames);
}

Result<std::vector<std::string>> ShowGroup(const LoadedGenerator& loaded,
                                           const GenerateFlags& flags,
                                           const BodyRecording& recording,
                                           const std::optional<IdentifiedModel>& physics) {
  const auto bodies = GenerateWith(loaded, recording, physics, flags.frames);
  if (!bodies.ok()) return bodies.error();
  Animation animation;
  animation.title = recording.pendulum.id + ", diffusion";
  animation.dt = recording.pendulum.scene.dt;
  AddRecorded(recording.pendulum.subject_ids, recording.bodies, &animation);
  AddForecast(recording.pendulum.subject_ids, bodies.value(), &animation);
  if (physics) {
    const Result<Prediction> predicted = PredictBeside(loaded, *physics, recording, flags.frames);
    if (!predicted.ok()) return predicted.error();
    AddPrediction(recording.pendulum, predicted.value(), {}, &animation);
  }
  std::vector<std::string> files;
  if (!flags.poses_out.empty()) {
    const auto written = WriteGroup(flags.poses_out, SceneOf(recording, bodies.value()));
    if (!written.ok()) return written;
    files = written.value();
  }
  MaybeError error;
  if (!flags.strip_out.empty()) {
    error = WriteFileAtomically(flags.strip_out, PoseStripSvg(animation, flags.poses));
    files.push_back(flags.strip_out);
  }
  if (!error && !flags.page_out.empty()) {
    error = WriteFileAtomically(flags.page_out, AnimationHtml(animation));
    files.push_back(flags.page_out);
  }
  if (error) return *error;
  return files;
}

}  // namespace pushid
