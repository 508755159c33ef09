// apps: pushid-crossvalidate: how well configurations predict recordings they have not seen.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/crossvalidate_flags.h"
#include "apps/flags/fit_option_flags.h"
#include "apps/flags/futures_flags.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_recording.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/problem/fold_file.h"
#include "ident/validation/frontier_svg.h"
#include "ident/validation/futures_validation.h"
#include "ident/validation/predictors.h"
#include "ident/validation/scores_json.h"
#include "ident/validation/scores_text.h"

namespace {

using namespace pushid;
using Predictors = std::vector<std::unique_ptr<Predictor>>;

using Candidates = std::vector<std::pair<std::string, FitOptions>>;

// The flags' own model and those of --compare. recordings: as in FitOptionsFromFlags.
Result<Candidates> ModelCandidates(const CrossvalidateFlags& flags, const FitOptions& options,
                                   const std::vector<PendulumRecording>* recordings) {
  Candidates candidates = {{options.preset, options}};
  for (const auto& [name, more] : flags.candidates) {
    const Result<FitOptions> candidate =
        MakeFitOptions(Merged(GivenFitFlags(), more), recordings, more);
    if (!candidate.ok()) return Error{"--compare, '" + name + "': " + candidate.error().message};
    candidates.emplace_back(name, candidate.value());
  }
  return candidates;
}

// Those that futures can be drawn from.
Result<Candidates> NoisyModels(const CrossvalidateFlags& flags, const FitOptions& options,
                               const std::vector<PendulumRecording>* recordings) {
  Result<Candidates> all = ModelCandidates(flags, options, recordings);
  if (!all.ok()) return all;
  Candidates noisy;
  for (auto& [name, candidate] : all.value()) {
    if (candidate.model.process_noise.Any()) noisy.emplace_back(name, candidate);
  }
  if (Given("observed")) {
    return Error{
        "--samples draws futures from frame 0, and --observed predicts from a later frame: leave "
        "one out"};
  }
  if (noisy.empty()) {
    return Error{
        "--samples: no candidate has process noise to draw from; add "
        "--process_noise=diagonal or --likelihood=innovation"};
  }
  return noisy;
}

// Where first frames are seen, the model started anew takes the place of ridge regression, which
// could not use them.
void AddBaselines(const FitOptions& options, Predictors* predictors) {
  const int observed = ObservedFrames();
  if (observed > 0) {
    predictors->push_back(std::make_unique<ModelPredictor>("re-anchored", options, observed,
                                                           FirstFrames::kReanchored));
  } else {
    predictors->push_back(std::make_unique<RidgePredictor>("ridge"));
  }
  predictors->push_back(std::make_unique<BaselinePredictor>("static", StaticBaseline, observed));
  predictors->push_back(
      std::make_unique<BaselinePredictor>("constant velocity", ConstantVelocityBaseline, observed));
}

// Two of one name could not be told apart in the tables.
MaybeError CheckNames(const Predictors& predictors) {
  std::set<std::string> names;
  for (const auto& predictor : predictors) {
    if (names.insert(predictor->name).second) continue;
    return Error{"--compare has more than one '" + predictor->name +
                 "'; give each configuration its own name"};
  }
  return std::nullopt;
}

// All of them. recordings: as in FitOptionsFromFlags.
Result<Predictors> MakePredictors(const CrossvalidateFlags& flags, const FitOptions& options,
                                  const std::vector<PendulumRecording>* recordings) {
  Predictors predictors;
  const int observed = ObservedFrames();
  const Result<Candidates> candidates = ModelCandidates(flags, options, recordings);
  if (!candidates.ok()) return candidates.error();
  for (const auto& [name, candidate] : candidates.value()) {
    if (candidate.body_weight > 0.0) {
      return Error{
          "--body_weight: '" + name +
          "' would be scored with a restoration that was trained on the held-out recordings; "
          "pushid-train-restoration --crossvalidate --body_weight retrains both"};
    }
    if (observed > 0 && candidate.model.push_tail == PushTail::kNone) {
      return Error{"--observed: '" + name +
                   "' has no push tail, which --observed estimates from the first frames; give it "
                   "--push_tail=exponential (the presets tail and group have it)"};
    }
    predictors.push_back(std::make_unique<ModelPredictor>(name, candidate, observed));
  }
  if (flags.baselines) AddBaselines(options, &predictors);
  // What the preset auto is called is known with the recordings.
  if (recordings == nullptr) return predictors;
  if (MaybeError error = CheckNames(predictors)) return *error;
  return predictors;
}

// What is wrong with the flags, before any recording is read.
MaybeError CheckFlags(const CrossvalidateFlags& flags) {
  const Result<FitOptions> options = FitOptionsFromFlags();
  if (!options.ok()) return options.error();
  const Result<Predictors> predictors = MakePredictors(flags, options.value(), nullptr);
  if (!predictors.ok()) return predictors.error();
  if (MaybeError error = CheckObservedFlag()) return error;
  for (const std::string& file : {flags.json_out, flags.frontier_out}) {
    if (file.empty()) continue;
    if (MaybeError error = CheckWritable(file)) return error;
  }
  return std::nullopt;
}

nlohmann::ordered_json ScoresJson(const std::vector<CrossValidation>& validations) {
  nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  for (const CrossValidation& validation : validations) {
    json["predictors"].push_back(ToJson(validation));
    if (&validation != &validations[0]) {
      json["paired_differences"].push_back(ToJson(Compare(validations[0], validation)));
    }
  }
  return json;
}

int Run() {
  const Result<CrossvalidateFlags> read = CrossvalidateFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const CrossvalidateFlags& flags = read.value();
  const Result<FuturesFlags> drawn = FuturesFlagsFromCommandLine(false);
  if (!drawn.ok()) return Fail(drawn.error());
  if (MaybeError error = CheckFlags(flags)) return Fail(*error);
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  const std::vector<PendulumRecording> pendulums =
      MakePendulumRecordings(recordings.value(), FitOptionsFromFlags().value().mapping);
  if (MaybeError error = CheckObservedFlag(pendulums)) return Fail(*error);
  const Result<FitOptions> options = FitOptionsFromFlags(&pendulums);
  if (!options.ok()) return Fail(options.error());
  for (const std::string& warning : OptionWarnings(GivenFitFlags(), options.value())) Warn(warning);
  const Result<Predictors> predictors = MakePredictors(flags, options.value(), &pendulums);
  if (!predictors.ok()) return Fail(predictors.error());
  const Result<Candidates> noisy = drawn.value().samples > 0
                                       ? NoisyModels(flags, options.value(), &pendulums)
                                       : Result<Candidates>(Candidates{});
  if (!noisy.ok()) return Fail(noisy.error());
  const Result<std::vector<Fold>> folds =
      flags.folds_file.empty()
          ? MakeFolds(pendulums, flags.scheme, flags.folds, flags.repeats, Seed())
          : ReadFolds(flags.folds_file, pendulums);
  if (!folds.ok()) return Fail(folds.error());

  std::vector<CrossValidation> validations;
  const RecordedBodies bodies = BodiesOfGroups(recordings.value());
  ProgressLine line;
  for (const auto& predictor : predictors.value()) {
    const auto show = [&](int done, int total) {
      line.Show(predictor->name + ": fold " + std::to_string(done) + " of " +
                std::to_string(total));
    };
    validations.push_back(
        CrossValidate(pendulums, folds.value(), *predictor, NumThreads(), show, bodies));
  }
  std::vector<HeldOutFutures> futures;
  for (const auto& [name, model] : noisy.value()) {
    futures.push_back(CrossValidateFutures(
        name, pendulums, folds.value(), model, drawn.value().samples, drawn.value().seed,
        NumThreads(), [&line, &of = name](int done, int total) {
          line.Show(of + ", futures: fold " + std::to_string(done) + " of " +
                    std::to_string(total));
        }));
  }
  std::vector<BandCoverage> bands;
  if (flags.bands) {
    BandOptions asked;
    asked.seed = Seed();
    bands = CrossValidateBands(
        pendulums, folds.value(), options.value(), asked, NumThreads(),
        [&line](int done, int total) {
          line.Show("bands: fold " + std::to_string(done) + " of " + std::to_string(total));
        });
  }
  line.Finish();
  std::printf("%s", CrossValidationText(validations).c_str());
  if (!flags.frontier_out.empty()) {
    const std::string svg = FrontierSvg(validations);
    if (MaybeError error = WriteFileAtomically(flags.frontier_out, svg)) return Fail(*error);
  }
  if (flags.bands) std::printf("\n%s", BandCoverageText(bands).c_str());
  if (!futures.empty()) std::printf("\n%s", HeldOutFuturesText(pendulums, futures).c_str());
  if (!flags.json_out.empty()) {
    nlohmann::ordered_json json = ScoresJson(validations);
    for (const HeldOutFutures& one : futures) json["futures"].push_back(ToJson(one.summary));
    if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::JoinRepeated("compare", ';', argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-crossvalidate fits on some recordings and scores the predictions of "
      "the others.\n\n  pushid-crossvalidate --recordings=M/manifest.json "
      "--setting=single --compare='pd: --preset=ldp'",
      Run);
}
