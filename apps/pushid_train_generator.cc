// apps: pushid-train-generator: learned generators of motion.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/train_generator_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/model_json.h"
#include "ident/problem/parallel.h"
#include "ident/training/generator_crossvalidation.h"
#include "ident/training/restoration_training.h"
#include "ident/training/training_run.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;
using Json = nlohmann::ordered_json;

std::string Inside(const std::string& folder, const char* name) {
  return (std::filesystem::path(folder) / name).string();
}

int CrossValidate(const TrainGeneratorFlags& flags, const std::vector<BodyRecording>& recordings) {
  TrainingLine line;
  const Result<GeneratorValidation> validation =
      CrossValidateGenerator(recordings, flags.options,
                             {flags.observed,
                              flags.scheme,
                              flags.crossvalidate,
                              flags.physics,
                              flags.pendulum_input,
                              flags.changes,
                              {},
                              flags.samples},
                             [&](const std::string& step, double done) { line.Show(step, done); });
  line.Finish();
  if (!validation.ok()) return Fail(validation.error());
  std::printf("%s", BodyText(validation.value().evaluation).c_str());
  const GroupSpread& spread = validation.value().spread;
  if (spread.samples > 0) std::printf("\n%s", SpreadText(spread).c_str());
  if (flags.json_out.empty()) return kDone;
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.value().evaluation, &json);
  if (spread.samples > 0) {
    json["spread"] = ToJson(spread);
    json["spread_of_noise_alone"] = ToJson(validation.value().noise_alone);
  }
  json["run"] = {{"training_seconds", validation.value().training_seconds}};
  if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
  return kDone;
}

// data: which clips or recordings, by name and hash.
int Train(TrainGeneratorFlags flags, const GeneratorSamples& samples, const Json& data) {
  SetForData(samples, &flags.options);
  flags.options.checkpoint = Inside(flags.out, "checkpoint.bin");
  if (MaybeError error = CheckWritable(flags.options.checkpoint)) return Fail(*error);
  SayWhenInterrupted(KeptCheckpoints(flags.out));
  TrainingLine line;
  Result<TrainedGenerator> trained =
      TrainGenerator(samples, flags.options, [&](const TrainingPoint& point, double done) {
        line.Show(point.stage + ", step " + std::to_string(point.epoch), done);
      });
  line.Finish();
  if (!trained.ok()) return Fail(trained.error());
  GeneratorSettings& settings = trained.value().networks.settings;
  settings.training = Json{{"version", Version()}, {"configuration", EffectiveFlags()}};
  (*settings.training)["data"] = data;
  (*settings.training)["curve"] = CurveJson(trained.value().curve);
  const std::string title = NameOf(flags.options.kind) + ", " + NameOf(flags.data) + ", " +
                            std::to_string(data.size()) + " motions";
  if (MaybeError error = WriteFileAtomically(Inside(flags.out, "curve.svg"),
                                             TrainingCurveSvg(trained.value().curve, title))) {
    return Fail(*error);
  }
  if (MaybeError error = WriteGenerator(flags.out, trained.value().networks)) return Fail(*error);
  std::printf("%s: %d seeds, %s s%s; %s\n", title.c_str(), flags.options.seeds,
              Rounded(line.Seconds(), 3).c_str(),
              trained.value().resumed ? " (resumed from a checkpoint)" : "",
              Inside(flags.out, "generator.json").c_str());
  return kDone;
}

constexpr int kFolds = 4;  // of the comparison
// Networks that are only compared are trained more briefly, by these shares of steps and epochs.
constexpr double kShareOfSteps = 0.4, kShareOfEpochs = 1.0 / 3.0;
const std::vector<double> kBlends = {0.25, 0.5, 0.75};

Result<FitOptions> PhysicsOf(const TrainGeneratorFlags& flags,
                             const std::vector<PendulumRecording>& pendulums) {
  if (flags.physics) return *flags.physics;
  Result<FitOptions> options = MakeFitOptions({}, &pendulums);
  if (!options.ok()) return options;
  options.value().num_threads = flags.options.num_threads;
  if (MaybeError error = PrepareFit(pendulums, &options.value())) return *error;
  return options;
}

MaybeError WritePhysics(const std::vector<PendulumRecording>& pendulums, const FitOptions& options,
                        const std::string& file) {
  const double begin = Now();
  FittedModel model;
  model.fit = Fit(pendulums, options);
  if (!model.fit.ok()) return Error{"the pendulum's fit failed: " + model.fit.message};
  model.provenance = ProvenanceOfRun();
  return WriteModelFile(file, model, options.num_threads, begin);
}

// --accuracy=best: compares, then writes physics of all recordings into --out, and the restoration
// where that won; the generator itself is still to be trained. Returns what is to forecast.
Result<ForecastChoice> TrainBeside(const TrainGeneratorFlags& flags,
                                   const std::vector<BodyRecording>& recordings) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const Result<FitOptions> physics = PhysicsOf(flags, pendulums);
  if (!physics.ok()) return physics.error();
  RestorationRunOptions chain;
  chain.fit = physics.value();
  chain.training.seed = flags.options.seed;
  chain.training.num_threads = flags.options.num_threads;
  // A generator of few steps, a try, is compared with a restoration of few.
  chain.training.effort =
      static_cast<double>(flags.options.diffusion.steps) / DiffusionTrainingOptions{}.steps;
  BestForecastOptions options;
  options.chain = chain;
  options.chain.training.effort *= kShareOfEpochs;
  options.generator = flags.options;
  int& steps = options.generator.diffusion.steps;
  steps = std::max(1, static_cast<int>(kShareOfSteps * steps));
  options.validation.observed = flags.observed;
  options.validation.scheme = flags.scheme;
  options.validation.folds = kFolds;
  options.validation.changes = flags.changes;
  options.validation.blends = kBlends;
  TrainingLine line;
  const RunProgress show = [&line](const std::string& step, double done) { line.Show(step, done); };
  const auto candidates = CompareForecasts(recordings, options, show);
  line.Finish();
  if (!candidates.ok()) return candidates.error();
  std::printf("%s", CandidatesText(candidates.value()).c_str());
  MaybeError error = WriteJson(Inside(flags.out, "candidates.json"), ToJson(candidates.value()));
  if (!error) error = WritePhysics(pendulums, physics.value(), Inside(flags.out, kChosenPhysics));
  if (error) return *error;
  const ForecastChoice choice = candidates.value().front().choice;
  if (choice.by != ForecastBy::kRestoration) return choice;
  const std::vector<int> all = Others({}, static_cast<int>(recordings.size()));
  const auto restoration = TrainFromRecordings(recordings, all, chain, show);
  line.Finish();
  if (!restoration.ok()) return restoration.error();
  error = WriteRestorationFile(Inside(flags.out, kChosenRestoration), restoration.value().file);
  if (error) return *error;
  return choice;
}

int FromClips(const TrainGeneratorFlags& flags) {
  const Result<MocapFolder> mocap = ReadMocapFolder(flags.folder);
  if (!mocap.ok()) return Fail(mocap.error());
  if (MaybeError error = MakeFolder(flags.out)) return Fail(*error);
  Json data = Json::array();
  for (const MocapClip& clip : mocap.value().clips) {
    if (clip.is_test) continue;
    data.push_back({{"clip", clip.name}, {"content_hash", clip.content_hash}});
  }
  return Train(flags, SamplesOf(mocap.value(), flags.with_validation), data);
}

int FromPushes(const TrainGeneratorFlags& flags) {
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  // Groups move without a push too; people by themselves, and physics, need one.
  const bool needs_push = !RowOf(flags.options.kind).groups || flags.physics ||
                          flags.accuracy == ForecastAccuracy::kBest;
  if (needs_push) {
    if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  }
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), SkeletonMapping::kExact);
  if (!bodies.ok()) return Fail(bodies.error());
  if (flags.crossvalidate > 0) return CrossValidate(flags, bodies.value());
  if (MaybeError error = MakeFolder(flags.out)) return Fail(*error);
  Json data = Json::array();
  const std::vector<int> all = Others({}, static_cast<int>(bodies.value().size()));
  std::vector<int> learnt = all, held;
  for (const BodyRecording& body : bodies.value()) {
    data.push_back({{"id", body.pendulum.id}, {"content_hash", body.pendulum.content_hash}});
  }
  if (flags.held_out > 0.0 && all.size() > 1) {
    SplitHeldOut(PendulumsOf(bodies.value()), all, flags.held_out, flags.options.seed, &learnt,
                 &held);
  }
  std::vector<GroupHips> hips;
  if (flags.pendulum_input) {
    const Result<FittedFolds> fitted =
        FitFolds(PendulumsOf(bodies.value()), all, *flags.physics, kHipFolds, flags.options.seed);
    if (!fitted.ok()) return Fail(fitted.error());
    hips = HipsOf(bodies.value(), all, fitted.value().predictions);
  }
  GeneratorSamples samples = SamplesOf(bodies.value(), learnt, held, flags.observed, hips);
  if (flags.accuracy == ForecastAccuracy::kBest) {
    const Result<ForecastChoice> choice = TrainBeside(flags, bodies.value());
    if (!choice.ok()) return Fail(choice.error());
    samples.settings.choice = choice.value();
  }
  return Train(flags, samples, data);
}

int Run() {
  const Result<TrainGeneratorFlags> flags = TrainGeneratorFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  SetBlasThreads(flags.value().options.num_threads);
  return flags.value().data == GeneratorData::kCmu ? FromClips(flags.value())
                                                   : FromPushes(flags.value());
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-train-generator trains networks that continue observed motion, for pushid-generate.\n"
      "Run again with the same --out, it continues an interrupted training.\n\n"
      "  pushid-train-generator --kind=particles --dataset=cmu --folder=cmu_mocap --out=generator",
      Run);
}
