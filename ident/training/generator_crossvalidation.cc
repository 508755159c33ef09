// ident: generators by folds.
#include "ident/training/generator_crossvalidation.h"

#include <algorithm>

#include "ident/bodies/body_evaluation.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/parallel.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {
namespace {

constexpr int kShown = 20;  // frames, of generator_shown_20

// What one fold scores its recordings by.
class FoldJudge {
 public:
  FoldJudge(const GeneratorValidationOptions& validation, const TrainedNetworks& trained,
            const std::optional<IdentifiedModel>& model)
      : validation_(validation), trained_(trained), model_(model) {}

  MaybeError Score(const BodyRecording& recording, std::map<std::string, BodyScore>* scores) const {
    GeneratorChanges changes = validation_.changes;
    changes.diffusion.sampled = std::make_shared<std::vector<Trajectories>>();
    if (MaybeError error = Add("generator", recording, validation_.observed, changes, scores)) {
      return error;
    }
    GeneratorChanges alone = changes;
    alone.diffusion.blend = 0.0;
    MaybeError error;
    if (changes.diffusion.blend > 0.0) {
      error = Add("generator_unblended", recording, validation_.observed, alone, scores);
    }
    alone.diffusion.sampled.reset();
    if (!error && validation_.observed != kShown && recording.num_frames() > kShown) {
      error = Add("generator_shown_20", recording, kShown, alone, scores);
    }
    const int observed = validation_.observed, seen = SeenByBaselines(observed);
    (*scores)["static"] = ScoreBodies(recording, StaticBodies(recording, seen), observed);
    (*scores)["constant_velocity"] =
        ScoreBodies(recording, ConstantVelocityBodies(recording, seen), observed);
    return error;
  }

 private:
  // Where the fold's physics have everybody; nothing without physics.
  Result<GroupHips> Hips(const BodyRecording& recording, const GeneratorSettings& settings,
                         std::map<std::string, BodyScore>* scores) const {
    if (!model_) return GroupHips();
    const Result<Prediction> predicted = PredictBeside(settings, *model_, recording);
    if (!predicted.ok()) return predicted.error();
    const Prediction& prediction = predicted.value();
    scores->emplace(
        "rigid",
        ScoreBodies(recording, RigidRestoration().Restore(PredictedPeople(recording, prediction)),
                    settings.observed));  // of the first call: as observed
    return PendulumHips(recording, prediction);
  }

  MaybeError Add(const std::string& name, const BodyRecording& recording, int observed,
                 const GeneratorChanges& changes, std::map<std::string, BodyScore>* scores) const {
    GeneratorSettings settings = trained_.settings;
    settings.observed = observed;
    GroupHips hips;
    if (changes.diffusion.blend > 0.0) {
      Result<GroupHips> predicted = Hips(recording, settings, scores);
      if (!predicted.ok()) return predicted.error();
      hips = std::move(predicted.value());
    }
    const auto bodies = GenerateBodies(settings, *trained_.Make(changes), recording, hips);
    if (!bodies.ok()) return bodies.error();
    (*scores)[name] = ScoreBodies(recording, bodies.value(), observed);
    if (name != "generator" || observed == 1) return std::nullopt;
    (*scores)["generator_all_frames"] = ScoreBodies(recording, bodies.value());
    return std::nullopt;
  }

  const GeneratorValidationOptions& validation_;
  const TrainedNetworks& trained_;
  const std::optional<IdentifiedModel>& model_;
};

}  // namespace

Result<GeneratorValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                                   const GeneratorTrainingOptions& options,
                                                   const GeneratorValidationOptions& validation,
                                                   const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const auto made = MakeFolds(pendulums, validation.scheme, validation.folds, 1, options.seed);
  if (!made.ok()) return made.error();
  const int total = static_cast<int>(recordings.size());
  GeneratorValidation result;
  std::vector<std::map<std::string, BodyScore>> by_recording(total);
  for (const Fold& fold : made.value()) {
    const std::vector<int> among = Others(fold.held_out, total);
    std::optional<IdentifiedModel> model;
    if (validation.physics) {
      if (progress) progress(fold.name + ", physics", 0.0);
      Result<FittedFolds> fitted = FitFolds(pendulums, among, *validation.physics, 0, options.seed);
      if (!fitted.ok()) return Error{fold.name + ": " + fitted.error().message};
      model = std::move(fitted.value().model);
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
    const FoldJudge judge(validation, trained.value().networks, model);
    for (int i : fold.held_out) {
      if (MaybeError error = judge.Score(recordings[i], &by_recording[i])) return *error;
    }
  }
  result.evaluation = SummarizeAll(recordings, by_recording);
  return result;
}

}  // namespace pushid
