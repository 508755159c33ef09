// apps: groups forecast and shown.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/recording_flags.h"
#include "apps/generate.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_files.h"
#include "ident/bodies/restoration_files.h"
#include "ident/forecasts/group_forecasts.h"
#include "ident/model/model_json.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"

namespace pushid {
namespace {

Result<Prediction> PredictBeside(const LoadedGenerator& loaded, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames) {
  Result<Prediction> predicted =
      PredictFrom(physics, recording.pendulum, ShownToPhysics(loaded.settings), frames);
  if (!predicted.ok() || predicted.value().status.ok) return predicted;
  return Error{"recording " + recording.pendulum.id + ": " + OutsideText(predicted.value().status) +
                   "; leave out --physics",
               physics.source};
}

// Where physics have the hips; none without physics.
Result<GroupHips> HipsBeside(const LoadedGenerator& loaded,
                             const std::optional<IdentifiedModel>& physics,
                             const BodyRecording& recording, int frames) {
  if (!physics) return GroupHips();
  const Result<Prediction> predicted = PredictBeside(loaded, *physics, recording, frames);
  if (!predicted.ok()) return predicted.error();
  return PendulumHips(recording, predicted.value());
}

Result<std::vector<std::string>> WriteGroup(const std::string& path, const BodyScene& scene) {
  if (IsBodyFile(path)) return WriteBodyFiles(path, scene);
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

MaybeError TakeChoice(GenerateFlags* flags, LoadedGenerator* loaded) {
  const std::optional<ForecastChoice> choice = loaded->settings.choice;
  if (!choice || !flags->physics.empty()) return std::nullopt;
  const std::filesystem::path folder(flags->model);
  const bool restores = choice->by == ForecastBy::kRestoration;
  // A choice without physics does not fail where physics do.
  if (restores || choice->blend > 0.0) flags->physics = (folder / kChosenPhysics).string();
  flags->changes.diffusion.blend = choice->blend;
  Result<LoadedGenerator> again = LoadGenerator(flags->model, flags->changes);
  if (!again.ok()) return again.error();
  *loaded = std::move(again.value());
  if (restores) {
    auto restoration = LoadRestoration((folder / kChosenRestoration).string());
    if (!restoration.ok()) return restoration.error();
    loaded->restoration = std::move(restoration.value());
  }
  std::printf(
      "selected by cross-validation: %s\n",
      restores ? "physics and restored bodies"
               : (NameOf(loaded->kind) + ", blended " + Rounded(choice->blend, 3) + " with physics")
                     .c_str());
  return std::nullopt;
}

Result<std::vector<BodyMotion>> GenerateWith(const LoadedGenerator& loaded,
                                             const BodyRecording& recording,
                                             const std::optional<IdentifiedModel>& physics,
                                             int frames) {
  if (loaded.restoration) {
    const Result<Prediction> predicted = PredictBeside(loaded, *physics, recording, frames);
    if (!predicted.ok()) return predicted.error();
    return RestoreBodies(*loaded.restoration, {}, PredictedPeople(recording, predicted.value()));
  }
  const Result<GroupHips> hips = HipsBeside(loaded, physics, recording, frames);
  if (!hips.ok()) return hips.error();
  return GenerateBodies(loaded.settings, *loaded.generator, recording, hips.value(), frames);
}

Result<GroupSpread> SpreadOf(const LoadedGenerator& loaded, const GenerateFlags& flags,
                             const std::vector<BodyRecording>& recordings,
                             const std::optional<IdentifiedModel>& physics) {
  GroupSpread spread;
  spread.samples = flags.samples;
  Random random(flags.seed);
  for (const BodyRecording& recording : recordings) {
    const Result<GroupHips> hips = HipsBeside(loaded, physics, recording, 0);
    if (!hips.ok()) return hips.error();
    AddSpread(
        *loaded.generator, recording, hips.value(), loaded.settings.observed,
        [&random] { return random.Normal(); }, &spread);
  }
  return spread;
}

Result<nlohmann::ordered_json> ShowSeconds(const LoadedGenerator& loaded,
                                           const std::vector<BodyRecording>& recordings,
                                           const std::optional<IdentifiedModel>& physics,
                                           const SocialCues& cues, int frames) {
  std::vector<GroupMotion> recorded, generated, rigid;
  const int observed = loaded.settings.observed;
  for (const BodyRecording& recording : recordings) {
    const double dt = recording.pendulum.scene.dt;
    const int pushed = recording.pendulum.pushed_person;
    recorded.push_back(RecordedGroup(recording, cues, recorded.size(), 1));
    auto bodies = GenerateWith(loaded, recording, physics, frames);
    if (!bodies.ok()) return bodies.error();
    generated.push_back({std::move(bodies.value()), dt, pushed, observed});
    if (!physics) continue;
    const Result<Prediction> predicted = PredictBeside(loaded, *physics, recording, frames);
    if (!predicted.ok()) return predicted.error();
    const auto people = PredictedPeople(recording, predicted.value());
    rigid.push_back({RigidRestoration().Restore(people), dt, pushed, observed});
  }
  nlohmann::ordered_json json;
  const auto show = [&](const std::string& name, const std::vector<GroupMotion>& motions) {
    const std::vector<ForecastSecond> seconds = BySecond(recorded, motions, cues.states);
    std::printf("\n%s", SecondsText(name, seconds).c_str());
    json[name] = ToJson(seconds);
  };
  show("generator", generated);
  if (physics) show("rigid", rigid);
  return json;
}

Result<SocialCues> FlaggedCues(const GenerateFlags& flags,
                               const std::vector<BodyRecording>& recordings) {
  SocialCues cues;
  if (!flags.states.empty()) {
    const Result<StateTable> table = ReadStates(flags.states);
    if (!table.ok()) return table.error();
    std::vector<std::string> ids;
    for (const ManifestRecording& entry : FlaggedManifest().value().recordings) {
      ids.push_back(entry.id);
    }
    Result<SocialCues> annotated = SocialCuesOf(table.value(), ids, recordings);
    if (!annotated.ok()) return annotated;
    cues = std::move(annotated.value());
  }
  if (flags.states_out.empty()) return cues;
  if (MaybeError error = WriteStates(flags.states_out, StatesInUse(recordings, cues)))
    return *error;
  return cues;
}

Result<std::vector<std::string>> ShowGroup(const LoadedGenerator& loaded,
                                           const GenerateFlags& flags,
                                           const BodyRecording& recording,
                                           const std::optional<IdentifiedModel>& physics,
                                           const std::vector<std::string>& figures) {
  const auto bodies = GenerateWith(loaded, recording, physics, flags.frames);
  if (!bodies.ok()) return bodies.error();
  Animation animation;
  animation.title = recording.pendulum.id + ", " + NameOf(loaded.kind);
  animation.dt = recording.pendulum.scene.dt;
  AddRecorded(recording.pendulum, recording.bodies, &animation);
  AddForecast(recording.pendulum.subject_ids, bodies.value(), &animation);
  AddPushes(recording.pendulum, &animation);
  animation.figures = figures;
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
    error = WriteFileAtomically(flags.strip_out, PoseStrip(animation, flags.poses).ToString());
    files.push_back(flags.strip_out);
  }
  if (!error && !flags.page_out.empty()) {
    error = WriteFileAtomically(flags.page_out, AnimationHtml({animation}));
    files.push_back(flags.page_out);
  }
  if (error) return *error;
  return files;
}

}  // namespace pushid
