// apps: pushid-train-restoration: networks that turn pendulums into bodies.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/train_restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "ident/training/restoration_chain.h"
#include "ident/training/training_run.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;

int CrossValidate(const TrainRestorationFlags& flags, const std::vector<BodyRecording>& recordings,
                  const RestorationRunOptions& options) {
  TrainingLine line;
  const ChainValidation validation = OrFail(
      CrossValidateChain(recordings, options, flags.scheme, flags.crossvalidate,
                         [&](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  std::printf("%s", BodyText(validation.evaluation).c_str());
  if (flags.json_out.empty()) return kDone;
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.evaluation, &json);
  json["run"] = {{"training_seconds", validation.training_seconds}};
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

nlohmann::ordered_json TrainingJson(const std::vector<BodyRecording>& recordings,
                                    const std::vector<BodyRecording>& more,
                                    const TrainedRestoration& trained) {
  nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  json["recordings"] = nlohmann::ordered_json::array();
  for (const BodyRecording& recording : recordings) {
    json["recordings"].push_back(
        {{"id", recording.pendulum.id}, {"content_hash", recording.pendulum.content_hash}});
  }
  int most = 0;
  for (const auto* seen : {&recordings, &more}) {
    for (const BodyRecording& recording : *seen) {
      most = std::max(most, recording.pendulum.num_people());
    }
  }
  json[kMostPeopleKey] = most;
  if (!trained.sizes.empty()) json["parameters"] = SizesJson(trained.sizes);
  json["curve"] = CurveJson(trained.curve);
  return json;
}

int Train(const TrainRestorationFlags& flags, const std::vector<BodyRecording>& recordings,
          RestorationRunOptions options) {
  OrFail(MakeFolder(flags.out));
  const auto in_out = [&flags](const char* name) {
    return (std::filesystem::path(flags.out) / name).string();
  };
  options.training.checkpoint = in_out("checkpoint.bin");
  OrFail(CheckWritable(options.training.checkpoint));
  const std::vector<int> all = Others({}, static_cast<int>(recordings.size()));
  TrainingLine line;
  SayWhenInterrupted(KeptCheckpoints(flags.out));
  const TrainedRestoration trained = OrFail(TrainFromRecordings(
      recordings, all, options,
      [&line](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  std::fprintf(stderr, "%s", SizesText(trained.sizes).c_str());
  RestorationFile file = trained.file;
  file.training = TrainingJson(recordings, options.more, trained);
  const std::string title = NameOf(options.training.kind) + " restoration, " +
                            std::to_string(recordings.size()) + " recordings (" +
                            RecordingFlagsFromCommandLine().setting + ")";
  OrFail(WriteFileAtomically(in_out("curve.svg"), TrainingCurveSvg(trained.curve, title)));
  OrFail(WriteRestorationFile(flags.out, file));
  const TrainingPoint& last = trained.curve.back();
  std::printf("%s: %zu points of the training curve, final held-out loss %s, %s s%s; %s\n",
              title.c_str(), trained.curve.size(), Rounded(last.validation_loss, 3).c_str(),
              Rounded(line.Seconds(), 3).c_str(),
              trained.resumed ? " (resumed from a checkpoint)" : "",
              in_out("restoration.json").c_str());
  return kDone;
}

// Those of --more_settings, without the ones that are learnt from (and scored) anyway.
void AddMoreRecordings(const std::string& settings, const std::vector<Recording>& known,
                       RestorationRunOptions* options) {
  if (settings.empty()) return;
  const std::vector<Recording> more = LoadBodiesOfSetting(settings);
  for (const Recording& recording : more) {
    bool is_known = false;
    for (const Recording& other : known) is_known = is_known || other.id == recording.id;
    if (is_known) continue;
    options->more.push_back(OrFail(MakeBodyRecording(recording)));
  }
}

int Run() {
  const TrainRestorationFlags flags = TrainRestorationFlagsFromCommandLine();
  if (flags.check) return kDone;
  SetBlasThreads(flags.options.training.num_threads);
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  CheckPushed(recordings);
  RestorationRunOptions options = flags.options;
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  CheckObservedFlag(PendulumsOf(bodies));
  AddMoreRecordings(flags.more_settings, recordings, &options);
  return flags.crossvalidate > 0 ? CrossValidate(flags, bodies, options)
                                 : Train(flags, bodies, options);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-train-restoration trains the networks that convert the path of a "
                        "pendulum into the motion of a body.\n"
                        "Run again with the same --out, it continues an interrupted training.\n\n"
                        "  pushid-train-restoration --recordings=M/manifest.json --setting=single "
                        "--more_settings=groups --model=model.json --out=restoration",
                        Run);
}
