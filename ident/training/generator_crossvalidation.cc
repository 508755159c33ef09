// ident: generators by folds.
#include "ident/training/generator_crossvalidation.h"

#include <chrono>

#include "ident/prediction/online_predictor.h"
#include "ident/results/model_rollout.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr int kShown = 20;  // frames, of generator_shown_20

// Where a fold's physics have everybody; nothing without physics.
Result<GroupHips> HipsOf(const std::optional<IdentifiedModel>& model,
                         const BodyRecording& recording, int observed) {
  if (!model) return GroupHips();
  const Result<Prediction> predicted =
      PredictFrom(*model, recording.pendulum, observed > 1 ? observed : 0);
  if (!predicted.ok()) return predicted.error();
  if (!predicted.value().status.ok) {
    return Error{"recording " + recording.pendulum.id + ": physics " +
                 OutsideText(predicted.value().status)};
  }
  return PendulumHips(recording, predicted.value().path);
}

// What one fold scores its recordings by.
struct FoldJudge {
  const GeneratorValidationOptions& validation;
  const TrainedNetworks& trained;
  const std::optional<IdentifiedModel>& model;

  MaybeError Add(const std::string& name, const BodyRecording& recording, int observed,
                 const GeneratorChanges& changes, std::map<std::string, BodyScore>* scores) const {
    GeneratorSettings settings = trained.settings;
    settings.observed = observed;
    const Result<GroupHips> hips = HipsOf(model, recording, observed);
    if (!hips.ok()) return hips.error();
    const auto bodies =
        GenerateBodies(settings, *MakeGenerator(trained, changes), recording, hips.value());
    if (!bodies.ok()) return bodies.error();
    (*scores)[name] = ScoreBodies(recording, bodies.value());
    if (name != "generator") return std::nullopt;
    (*scores)["generator_after_observed"] = ScoreBodies(recording, bodies.value(), observed);
    return std::nullopt;
  }

  MaybeError Score(const BodyRecording& recording, std::map<std::string, BodyScore>* scores) const {
    const int observed = validation.observed;
    if (MaybeError error = Add("generator", recording, observed, validation.changes, scores)) {
      return error;
    }
    if (trained.kind() == GeneratorKind::kDiffusion) {
      GeneratorChanges alone = validation.changes;
      alone.diffusion.blend = 0.0;
      const bool blends = validation.changes.diffusion.blend > 0.0;
      if (MaybeError error = blends ? Add("generator_unblended", recording, observed, alone, scores)
                                    : std::nullopt) {
        return error;
      }
      if (observed != kShown && recording.num_frames() > kShown) {
        const MaybeError error =
            Add("generator_shown_20", recording, kShown, validation.changes, scores);
        if (error) return error;
      }
    }
    (*scores)["static"] = ScoreBodies(recording, StaticBodies(recording));
    (*scores)["constant_velocity"] = ScoreBodies(recording, ConstantVelocityBodies(recording));
    return std::nullopt;
  }
};

}  // namespace

Result<ChainValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                               const GeneratorTrainingOptions& options,
                                               const GeneratorValidationOptions& validation,
                                               const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const auto made =
      MakeFolds(pendulums, validation.scheme, validation.folds, 1, options.particles.seed);
  if (!made.ok()) return made.error();
  const int total = static_cast<int>(recordings.size());
  ChainValidation result;
  std::vector<std::map<std::string, BodyScore>> by_recording(total);
  for (const Fold& fold : made.value()) {
    const std::vector<int> among = Others(fold.held_out, total);
    std::optional<IdentifiedModel> model;
    if (validation.physics) {
      if (progress) progress(fold.name + ", physics", 0.0);
      model = FitTo(pendulums, among, *validation.physics);
      if (!model) return Error{fold.name + ": the pendulum's fit found no usable optimum"};
    }
    const GeneratorSamples samples = SamplesOf(recordings, among, {}, validation.observed);
    GeneratorTrainingOptions of_fold = options;
    SetForData(samples, &of_fold);
    const double before = Now();
    const Result<TrainedGenerator> trained =
        TrainGenerator(samples, of_fold, [&](const TrainingPoint& point, double done) {
          if (!progress) return;
          progress(fold.name + ", " + point.stage + ", step " + std::to_string(point.epoch), done);
        });
    if (!trained.ok()) return trained.error();
    result.training_seconds.push_back(Now() - before);
    const FoldJudge judge = {validation, trained.value().networks, model};
    for (int i : fold.held_out) {
      if (MaybeError error = judge.Score(recordings[i], &by_recording[i])) return *error;
    }
  }
  BodyScores all;
  for (const auto& scores : by_recording) {
    for (const auto& [name, score] : scores) all[name].push_back(score);
  }
  result.evaluation = SummarizeAll(recordings, all);
  return result;
}

}  // namespace pushid
