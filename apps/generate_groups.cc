// apps: groups forecast and shown.
#include <cstdio>

#include "apps/flags/recording_flags.h"
#include "apps/generate.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_files.h"
#include "ident/model/model_json.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"

namespace pushid {
namespace {

Prediction PredictBeside(const LoadedGenerator& loaded, const IdentifiedModel& physics,
                         const BodyRecording& recording, int frames) {
  const Prediction predicted =
      OrFail(PredictFrom(physics, recording.pendulum, ShownToPhysics(loaded.settings), frames));
  if (predicted.status.ok) return predicted;
  throw Error{"recording " + recording.pendulum.id + ": " + OutsideText(predicted.status) +
                  "; leave out --physics",
              physics.source};
}

// Where physics have the hips; none without physics.
GroupHips HipsBeside(const LoadedGenerator& loaded, const std::optional<IdentifiedModel>& physics,
                     const BodyRecording& recording, int frames) {
  if (!physics) return GroupHips();
  return PendulumHips(recording, PredictBeside(loaded, *physics, recording, frames));
}

std::vector<std::string> WriteGroup(const std::string& path, const BodyScene& scene) {
  if (IsBodyFile(path)) return OrFail(WriteBodyBvh(path, scene));
  OrFail(WriteJointsCsv(path, scene));
  return {path};
}

}  // namespace

std::optional<IdentifiedModel> LoadPhysics(const std::string& file) {
  if (file.empty()) return std::nullopt;
  IdentifiedModel model = ModelOf(OrFail(ReadFittedModel(file)).fit);
  model.source = file;
  return model;
}

std::vector<BodyMotion> GenerateWith(const LoadedGenerator& loaded, const BodyRecording& recording,
                                     const std::optional<IdentifiedModel>& physics, int frames) {
  const GroupHips hips = HipsBeside(loaded, physics, recording, frames);
  return OrFail(GenerateBodies(loaded.settings, *loaded.generator, recording, hips, frames));
}

SocialCues FlaggedCues(const GenerateFlags& flags, const std::vector<BodyRecording>& recordings) {
  SocialCues cues;
  if (!flags.states.empty()) {
    const StateTable table = OrFail(ReadStates(flags.states));
    std::vector<std::string> ids;
    for (const ManifestRecording& entry : FlaggedManifest().value().recordings) {
      ids.push_back(entry.id);
    }
    cues = OrFail(SocialCuesOf(table, ids, recordings));
  }
  if (flags.states_out.empty()) return cues;
  OrFail(WriteStates(flags.states_out, StatesInUse(recordings, cues)));
  return cues;
}

std::vector<std::string> ShowGroup(const LoadedGenerator& loaded, const GenerateFlags& flags,
                                   const BodyRecording& recording,
                                   const std::optional<IdentifiedModel>& physics,
                                   const std::vector<std::string>& figures) {
  const auto bodies = GenerateWith(loaded, recording, physics, flags.frames);
  Animation animation;
  animation.title = recording.pendulum.id + ", " + NameOf(loaded.kind);
  animation.dt = recording.pendulum.scene.dt;
  AddRecorded(recording.pendulum, recording.bodies, &animation);
  AddForecast(recording.pendulum.subject_ids, bodies, &animation);
  AddPushes(recording.pendulum, &animation);
  animation.figures = figures;
  if (physics) {
    const Prediction predicted = PredictBeside(loaded, *physics, recording, flags.frames);
    AddPrediction(recording.pendulum, predicted, {}, &animation);
  }
  std::vector<std::string> files;
  if (!flags.poses_out.empty()) {
    files = WriteGroup(flags.poses_out, SceneOf(recording, bodies));
  }
  if (!flags.svg_out.empty()) {
    OrFail(WriteFileAtomically(flags.svg_out, PoseStrip(animation, kStripPoses).ToString()));
    files.push_back(flags.svg_out);
  }
  if (!flags.html_out.empty()) {
    OrFail(WriteFileAtomically(flags.html_out, AnimationHtml({animation})));
    files.push_back(flags.html_out);
  }
  return files;
}

}  // namespace pushid
