// ident: generators by folds.
#include "ident/training/generator_crossvalidation.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/figures/text_table.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"
#include "ident/problem/parallel.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {
namespace {

std::string BlendName(double blend) { return "generator_blend_" + Rounded(blend, 3); }

constexpr int kShown = 20;  // frames, of generator_shown_20

// What one fold scores its recordings by.
class FoldJudge {
 public:
  FoldJudge(const GeneratorValidationOptions& validation, const TrainedNetworks& trained,
            const std::optional<IdentifiedModel>& model)
      : validation_(validation), trained_(trained), model_(model) {}

  MaybeError AddSpreads(const BodyRecording& recording, GeneratorValidation* result) const {
    GroupHips hips;
    std::map<std::string, BodyScore> unused;
    if (validation_.changes.diffusion.blend > 0.0) {
      Result<GroupHips> predicted = Hips(recording, trained_.settings, &unused);
      if (!predicted.ok()) return predicted.error();
      hips = std::move(predicted.value());
    }
    GeneratorChanges still = validation_.changes;
    still.diffusion.push_spread = 0.0;
    for (const auto& [changes, spread] :
         {std::pair(&validation_.changes, &result->spread),
          std::pair<const GeneratorChanges*, GroupSpread*>(&still, &result->noise_alone)}) {
      Random random(changes->seed);
      AddSpread(
          *MakeGenerator(trained_, *changes), recording, hips, validation_.observed,
          [&random] { return random.Normal(); }, spread);
    }
    return std::nullopt;
  }

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
    for (size_t b = 0; b < validation_.blends.size() && !error; ++b) {
      alone.diffusion.blend = validation_.blends[b];
      error = Add(BlendName(validation_.blends[b]), recording, validation_.observed, alone, scores);
    }
    alone.diffusion.blend = 0.0;
    alone.diffusion.sampled.reset();
    if (!error && validation_.observed != kShown && validation_.blends.empty() &&
        recording.num_frames() > kShown) {
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
    const Result<Prediction> predicted =
        PredictFrom(*model_, recording.pendulum, ShownToPhysics(settings));
    if (!predicted.ok()) return predicted.error();
    if (!predicted.value().status.ok) {
      return Error{"recording " + recording.pendulum.id + ": physics " +
                   OutsideText(predicted.value().status)};
    }
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
    const auto bodies =
        GenerateBodies(settings, *MakeGenerator(trained_, changes), recording, hips);
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
  result.spread.samples = result.noise_alone.samples = validation.samples;
  std::vector<std::map<std::string, BodyScore>> by_recording(total);
  for (const Fold& fold : made.value()) {
    const std::vector<int> among = Others(fold.held_out, total);
    std::optional<IdentifiedModel> model;
    if (!validation.pendulums.empty()) {
      model = validation.pendulums[&fold - made.value().data()];
    } else if (validation.physics) {
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
      MaybeError error = judge.Score(recordings[i], &by_recording[i]);
      if (!error && validation.samples > 0) {
        error = judge.AddSpreads(recordings[i], &result);
      }
      if (error) return *error;
    }
  }
  result.evaluation = SummarizeAll(recordings, by_recording);
  return result;
}

Result<std::vector<ForecastCandidate>> CompareForecasts(
    const std::vector<BodyRecording>& recordings, const BestForecastOptions& options,
    const RunProgress& progress) {
  const auto chain = CrossValidateChain(recordings, options.chain, options.validation.scheme,
                                        options.validation.folds, progress);
  if (!chain.ok()) return chain.error();
  GeneratorValidationOptions of_generator = options.validation;
  of_generator.pendulums = chain.value().models;
  const auto generator =
      CrossValidateGenerator(recordings, options.generator, of_generator, progress);
  if (!generator.ok()) return generator.error();
  const BodyEvaluation& scores = generator.value().evaluation;
  const std::string kind = NameOf(options.generator.kind);
  std::vector<ForecastCandidate> candidates = {{kind, {}, scores.at("generator")},
                                               {"physics, restored bodies",
                                                {ForecastBy::kRestoration, 0.0},
                                                chain.value().evaluation.at("restoration")}};
  for (const double blend : of_generator.blends) {
    candidates.push_back({kind + ", blended " + Rounded(blend, 3) + " with physics",
                          {ForecastBy::kGenerator, blend},
                          scores.at(BlendName(blend))});
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.summary.mean.value[kMpjpe] < b.summary.mean.value[kMpjpe];
  });
  return candidates;
}

std::string CandidatesText(const std::vector<ForecastCandidate>& candidates) {
  TextTable table =
      TextTable::OfNumbers({"held out", "MPJPE m", "+-", "hipADE m", "hipFDE m", "FSE cm"});
  for (const ForecastCandidate& candidate : candidates) {
    const BodyMean& mean = candidate.summary.mean;
    table.Add({candidate.name, Rounded(mean.value[kMpjpe], 3), Rounded(mean.error[kMpjpe], 2),
               Rounded(mean.value[kHipAde], 3), Rounded(mean.value[kHipFde], 3),
               Rounded(mean.value[kFse], 2)});
  }
  return table.ToString() + "chosen: " + candidates.front().name + "\n";
}

nlohmann::ordered_json ToJson(const std::vector<ForecastCandidate>& candidates) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ForecastCandidate& candidate : candidates) {
    rows.push_back({{"name", candidate.name},
                    {"by", NameOf(candidate.choice.by)},
                    {"blend", candidate.choice.blend},
                    {"mean", MeanJson(candidate.summary.mean)}});
  }
  return {{"schema", "pushid-candidates/1"}, {"candidates", rows}};
}

}  // namespace pushid
