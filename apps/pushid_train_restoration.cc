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
  const Result<ChainValidation> validation =
      CrossValidateChain(recordings, options, flags.scheme, flags.crossvalidate,
                         [&](const std::string& step, double done) { line.Show(step, done); });
  line.Finish();
  if (!validation.ok()) return Fail(validation.error());
  std::printf("%s", BodyText(validation.value().evaluation).c_str());
  if (flags.json_out.empty()) return kDone;
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.value().evaluation, &json);
  json["run"] = {{"training_seconds", validation.value().training_seconds},
                 {"rounds", validation.value().rounds}};
  if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
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

// Alone, or as a whole with the pendulum.
Result<TrainedRestoration> Learn(const TrainRestorationFlags& flags,
                                 const std::vector<BodyRecording>& recordings,
                                 const std::vector<int>& all, const RestorationRunOptions& options,
                                 TrainingLine* line) {
  const auto told = [line](const std::string& step, double done) { line->Show(step, done); };
  if (options.fit.body_weight <= 0.0) {
    SayWhenInterrupted(KeptCheckpoints(flags.out));
    return TrainFromRecordings(recordings, all, options, told);
  }
  SayWhenInterrupted("joint training keeps no checkpoints; run the same command to start again");
  Result<TrainedChain> chain = TrainChain(recordings, all, options, told);
  if (!chain.ok()) return chain.error();
  return std::move(chain.value().restoration);
}

int Train(const TrainRestorationFlags& flags, const std::vector<BodyRecording>& recordings,
          RestorationRunOptions options) {
  if (MaybeError error = MakeFolder(flags.out)) return Fail(*error);
  const auto in_out = [&flags](const char* name) {
    return (std::filesystem::path(flags.out) / name).string();
  };
  options.training.checkpoint = in_out("checkpoint.bin");
  if (MaybeError error = CheckWritable(options.training.checkpoint)) return Fail(*error);
  const std::vector<int> all = Others({}, static_cast<int>(recordings.size()));
  TrainingLine line;
  const Result<TrainedRestoration> learnt = Learn(flags, recordings, all, options, &line);
  line.Finish();
  if (!learnt.ok()) return Fail(learnt.error());
  const TrainedRestoration& trained = learnt.value();
  std::fprintf(stderr, "%s", SizesText(trained.sizes).c_str());
  RestorationFile file = trained.file;
  file.training = TrainingJson(recordings, options.more, trained);
  const std::string title = NameOf(options.training.kind) + " restoration, " +
                            std::to_string(recordings.size()) + " recordings (" +
                            RecordingFlagsFromCommandLine().setting + ")";
  if (MaybeError error =
          WriteFileAtomically(in_out("curve.svg"), TrainingCurveSvg(trained.curve, title))) {
    return Fail(*error);
  }
  if (MaybeError error = WriteRestorationFile(flags.out, file)) return Fail(*error);
  const TrainingPoint& last = trained.curve.back();
  std::printf("%s: %zu points of the training curve, final held-out loss %s, %s s%s; %s\n",
              title.c_str(), trained.curve.size(), Rounded(last.validation_loss, 3).c_str(),
              Rounded(line.Seconds(), 3).c_str(),
              trained.resumed ? " (resumed from a checkpoint)" : "",
              in_out("restoration.json").c_str());
  return kDone;
}

// Those of --more_settings, without the ones that are learnt from (and scored) anyway.
MaybeError AddMoreRecordings(const std::string& settings, const std::vector<Recording>& known,
                             RestorationRunOptions* options) {
  if (settings.empty()) return std::nullopt;
  const Result<std::vector<Recording>> more = LoadBodiesOfSetting(settings);
  if (!more.ok()) return more.error();
  for (const Recording& recording : more.value()) {
    bool is_known = false;
    for (const Recording& other : known) is_known = is_known || other.id == recording.id;
    if (is_known) continue;
    Result<BodyRecording> body = MakeBodyRecording(recording, options->fit.mapping);
    if (!body.ok()) return body.error();
    options->more.push_back(std::move(body.value()));
  }
  return std::nullopt;
}

int Run() {
  const Result<TrainRestorationFlags> read = TrainRestorationFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const TrainRestorationFlags& flags = read.value();
  if (flags.check) return kDone;
  SetBlasThreads(flags.options.training.num_threads);
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  RestorationRunOptions options = flags.options;
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), options.fit.mapping);
  if (!bodies.ok()) return Fail(bodies.error());
  if (MaybeError error = CheckObservedFlag(PendulumsOf(bodies.value()))) return Fail(*error);
  if (MaybeError error = AddMoreRecordings(flags.more_settings, recordings.value(), &options)) {
    return Fail(*error);
  }
  return flags.crossvalidate > 0 ? CrossValidate(flags, bodies.value(), options)
                                 : Train(flags, bodies.value(), options);
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
