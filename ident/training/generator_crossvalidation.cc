// ident: generators by folds.
#include "ident/training/generator_crossvalidation.h"

#include <algorithm>
#include <chrono>

#include "ident/generators/push_particles.h"
#include "ident/problem/folds.h"

namespace pushid {
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

MaybeError Score(const TrainedParticles& trained, const BodyRecording& recording,
                 std::map<std::string, BodyScore>* scores) {
  const auto bodies = GenerateBodies(trained.settings, *MakeGenerator(trained), recording);
  if (!bodies.ok()) return bodies.error();
  (*scores)["generator"] = ScoreBodies(recording, bodies.value());
  (*scores)["generator_after_observed"] =
      ScoreBodies(recording, bodies.value(), trained.settings.observed);
  (*scores)["static"] = ScoreBodies(recording, StaticBodies(recording));
  (*scores)["constant_velocity"] = ScoreBodies(recording, ConstantVelocityBodies(recording));
  return std::nullopt;
}

}  // namespace

Result<ChainValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                               const GeneratorTrainingOptions& options,
                                               int observed, int folds,
                                               const RunProgress& progress) {
  const auto made =
      MakeFolds(PendulumsOf(recordings), FoldScheme::kStratified, folds, 1, options.particles.seed);
  if (!made.ok()) return made.error();
  const int total = static_cast<int>(recordings.size());
  ChainValidation validation;
  std::vector<std::map<std::string, BodyScore>> by_recording(total);
  for (const Fold& fold : made.value()) {
    std::vector<int> among;
    for (int i = 0; i < total; ++i) {
      if (!std::binary_search(fold.held_out.begin(), fold.held_out.end(), i)) among.push_back(i);
    }
    const GeneratorSamples samples = SamplesOf(recordings, among, {}, observed);
    GeneratorTrainingOptions of_fold = options;
    SetForData(samples, &of_fold);
    const double before = Now();
    const Result<TrainedGenerator> trained =
        TrainGenerator(samples, of_fold, [&](const TrainingPoint& point, double done) {
          if (!progress) return;
          progress(fold.name + ", " + point.stage + ", step " + std::to_string(point.epoch), done);
        });
    if (!trained.ok()) return trained.error();
    validation.training_seconds.push_back(Now() - before);
    for (int i : fold.held_out) {
      const MaybeError error = Score(trained.value().particles, recordings[i], &by_recording[i]);
      if (error) return *error;
    }
  }
  BodyScores all;
  for (const auto& scores : by_recording) {
    for (const auto& [name, score] : scores) all[name].push_back(score);
  }
  validation.evaluation = SummarizeAll(recordings, all);
  return validation;
}

}  // namespace pushid
