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
  const GeneratorValidation validation = OrFail(CrossValidateGenerator(
      recordings, flags.options,
      {flags.observed, flags.scheme, flags.crossvalidate, flags.physics, flags.changes},
      [&](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  std::printf("%s", BodyText(validation.evaluation).c_str());
  if (flags.json_out.empty()) return kDone;
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.evaluation, &json);
  json["run"] = {{"training_seconds", validation.training_seconds}};
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

// data: which clips or recordings, by name and hash.
int Train(TrainGeneratorFlags flags, const GeneratorSamples& samples, const Json& data) {
  SetForData(samples, &flags.options);
  flags.options.checkpoint = Inside(flags.out, "checkpoint.bin");
  OrFail(CheckWritable(flags.options.checkpoint));
  SayWhenInterrupted(KeptCheckpoints(flags.out));
  TrainingLine line;
  TrainedGenerator trained =
      OrFail(TrainGenerator(samples, flags.options, [&](const TrainingPoint& point, double done) {
        line.Show(point.stage + ", step " + std::to_string(point.epoch), done);
      }));
  line.Finish();
  GeneratorSettings& settings = trained.networks.settings;
  settings.training = Json{{"version", Version()}, {"configuration", EffectiveFlags()}};
  (*settings.training)["data"] = data;
  (*settings.training)["curve"] = CurveJson(trained.curve);
  const std::string title =
      NameOf(flags.options.kind) + ", " + std::to_string(data.size()) + " motions";
  OrFail(
      WriteFileAtomically(Inside(flags.out, "curve.svg"), TrainingCurveSvg(trained.curve, title)));
  OrFail(WriteGenerator(flags.out, trained.networks));
  std::printf("%s: %d seeds, %s s%s; %s\n", title.c_str(), flags.options.seeds,
              Rounded(line.Seconds(), 3).c_str(),
              trained.resumed ? " (resumed from a checkpoint)" : "",
              Inside(flags.out, "generator.json").c_str());
  return kDone;
}

constexpr double kHeldOut = 0.15;  // share of the recordings that only show how the training goes

int FromClips(const TrainGeneratorFlags& flags) {
  const MocapFolder mocap = OrFail(ReadMocapFolder(flags.folder));
  OrFail(MakeFolder(flags.out));
  Json data = Json::array();
  for (const MocapClip& clip : mocap.clips) {
    if (clip.is_test) continue;
    data.push_back({{"clip", clip.name}, {"content_hash", clip.content_hash}});
  }
  return Train(flags, SamplesOf(mocap, !flags.hold_out), data);
}

int FromGroups(const TrainGeneratorFlags& flags) {
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  if (flags.physics) CheckPushed(recordings);  // groups move without a push too
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  if (flags.crossvalidate > 0) return CrossValidate(flags, bodies);
  OrFail(MakeFolder(flags.out));
  Json data = Json::array();
  const std::vector<int> all = Others({}, static_cast<int>(bodies.size()));
  std::vector<int> learnt = all, held;
  for (const BodyRecording& body : bodies) {
    data.push_back({{"id", body.pendulum.id}, {"content_hash", body.pendulum.content_hash}});
  }
  if (flags.hold_out && all.size() > 1) {
    SplitHeldOut(PendulumsOf(bodies), all, kHeldOut, flags.options.seed, &learnt, &held);
  }
  return Train(flags, SamplesOf(bodies, learnt, held, flags.observed), data);
}

int Run() {
  const TrainGeneratorFlags flags = TrainGeneratorFlagsFromCommandLine();
  SetBlasThreads(flags.options.num_threads);
  return RowOf(flags.options.kind).groups ? FromGroups(flags) : FromClips(flags);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-train-generator trains networks that continue observed motion, for pushid-generate.\n"
      "Run again with the same --out, it continues an interrupted training.\n\n"
      "  pushid-train-generator --folder=cmu_mocap --out=generator",
      Run);
}
