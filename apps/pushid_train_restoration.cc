// apps: pushid-train-restoration: networks that turn pendulums into bodies.
#include "apps/flags/command_line.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/postprocess_flags.h"
#include "apps/flags/recording_flags.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "ident/model/model_json.h"
#include "ident/problem/folds.h"
#include "ident/training/restoration_training.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;

const std::string kKind = [] {
  std::vector<std::string> kinds;
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (row.trained) kinds.push_back(std::string(row.name) + " (" + row.what + ")");
  }
  return "kind of restoration: " + Joined(kinds);
}();

}  // namespace

DEFINE_string(model, "", "model that pushid-fit --model_out wrote: the pendulum to fit");
DEFINE_string(kind, pushid::RowOf(pushid::RestorationTrainingOptions{}.kind).name, kKind.c_str());
DEFINE_string(coordinates, pushid::NameOf(pushid::RestorationTrainingOptions{}.coordinates),
              "cvae: joints relative to the rod's tip (tip), or to the hip at frame 0 (ldp)");
DEFINE_string(sees, pushid::NameOf(pushid::RestorationTrainingOptions{}.view),
              "input of the poses: the person's pendulum (pendulum), also those of the neighbours "
              "(neighbours, window only), or none, for comparison (pose: window uses the first "
              "pose and the push, cvae the previous pose)");
DEFINE_bool(halves, pushid::RestorationTrainingOptions{}.halves,
            "cvae: a network for the lower and one for the upper body (false: one for both)");
DEFINE_string(
    training, pushid::NameOf(pushid::RestorationTrainingOptions{}.training),
    "cvae: pushid's training (own), or as published: Adam at 1e-4 (autoencoders: falling to "
    "1e-7), sigma compared, the latent variable drawn, no predicted pendulums (published)");
DEFINE_string(out, "", "folder to write: restoration.json, weights.npy, curve.svg");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_bool(check, false, "only check the flags: nothing is read, trained or written");
DEFINE_string(scheme, NameOf(FoldScheme::kStratified),
              "--crossvalidate: stratified (folds by setting, strength and subject) or interleaved "
              "(recordings of a setting assigned to folds in turn)");
DEFINE_int32(crossvalidate, 0,
             "number of folds: instead of writing a restoration, refit pendulum and restoration in "
             "every fold and score the held-out recordings; 0: off");
DEFINE_double(effort, pushid::RestorationTrainingOptions{}.effort,
              "factor on the number of training steps");
DEFINE_string(more_settings, "",
              "also train the bodies on the recorded pendulums of these settings (named as in "
              "--setting); they are neither fitted nor scored");
DEFINE_uint64(seed, pushid::RestorationTrainingOptions{}.seed,
              "seed of weights, batches, noise and folds");
DEFINE_int32(num_threads, pushid::RestorationTrainingOptions{}.num_threads,
             "threads of the training; only one repeats to the last bit");

namespace {

bool AtDefault(const char* flag) {
  return gflags::GetCommandLineFlagInfoOrDie(flag).current_value ==
         gflags::GetCommandLineFlagInfoOrDie(flag).default_value;
}

// Throws where flags do not go with the kind.
void CheckKind(RestorationKind kind, RestorationView view) {
  if (view == RestorationView::kNeighbours && !RowOf(kind).sees_neighbours) {
    throw Error{"--sees=neighbours needs --kind=window"};
  }
  for (const auto& [flag, given] :
       {std::pair("halves", "--nohalves"), std::pair("training", "--training")}) {
    if (kind == RestorationKind::kCvae || AtDefault(flag)) continue;
    throw Error{std::string(given) + " needs --kind=" + NameOf(RestorationKind::kCvae)};
  }
  if (AtDefault("coordinates")) return;
  if (kind != RestorationKind::kCvae || view == RestorationView::kPose) {
    throw Error{
        "--coordinates needs --kind=cvae --sees=pendulum: without a pendulum there is no tip"};
  }
}

FoldScheme Scheme() {
  FoldScheme scheme;
  OrFail(ParseName("--scheme", FLAGS_scheme, &scheme));
  return scheme;
}

// With the fit's options read from the model, unless flags are only checked.
RestorationRunOptions OptionsFromCommandLine() {
  RestorationRunOptions options;
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
  const auto kind = FromName<RestorationKind>(FLAGS_kind);
  if (!kind || !RowOf(*kind).trained) {
    throw Error{"--kind is '" + FLAGS_kind + "'; it must be " + TrainedRestorationKinds()};
  }
  RestorationTrainingOptions& training = options.training;
  training.kind = *kind;
  OrFail(ParseName("--coordinates", FLAGS_coordinates, &training.coordinates));
  OrFail(ParseName("--sees", FLAGS_sees, &training.view));
  OrFail(ParseName("--training", FLAGS_training, &training.training));
  CheckKind(*kind, training.view);
  if (FLAGS_crossvalidate == 0) {
    Require("out", FLAGS_out, "name the folder to write");
  } else if (FLAGS_crossvalidate < 2) {
    throw Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (Given("forecast")) {
    throw Error{"--forecast: restorations are scored on both forecasters together; leave it out"};
  }
  options.observed = ObservedFrames();
  if (options.observed > 0 && FLAGS_crossvalidate == 0) {
    throw Error{"--observed needs --crossvalidate: training uses whole recordings"};
  }
  if (!(FLAGS_effort > 0.0 && FLAGS_effort <= 100.0)) {
    throw Error{"--effort must lie above 0 and not above 100"};
  }
  CheckRange("num_threads", FLAGS_num_threads, 1, 1024);
  training.halves = FLAGS_halves;
  training.effort = FLAGS_effort;
  training.seed = FLAGS_seed;
  training.num_threads = FLAGS_num_threads;
  options.postprocess = PostprocessFromCommandLine();
  if (FLAGS_check) return options;
  options.fit = OrFail(ReadFittedModel(FLAGS_model)).fit.options;
  options.fit.num_threads = FLAGS_num_threads;
  Scheme();  // refuses other names
  if (FLAGS_crossvalidate == 0 && Given("scheme")) throw Error{"--scheme needs --crossvalidate"};
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  return options;
}

int CrossValidate(const std::vector<BodyRecording>& recordings,
                  const RestorationRunOptions& options) {
  TrainingLine line;
  const ChainValidation validation = OrFail(
      CrossValidateChain(recordings, options, Scheme(), FLAGS_crossvalidate,
                         [&](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  std::printf("%s", BodyText(validation.evaluation).c_str());
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  AddBodyJson(validation.evaluation, &json);
  json["run"] = {{"training_seconds", validation.training_seconds}};
  WriteIfNamed(FLAGS_json_out, json);
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

int Train(const std::vector<BodyRecording>& recordings, RestorationRunOptions options) {
  OrFail(MakeFolder(FLAGS_out));
  const auto in_out = [](const char* name) {
    return (std::filesystem::path(FLAGS_out) / name).string();
  };
  options.training.checkpoint = in_out("checkpoint.bin");
  OrFail(CheckWritable(options.training.checkpoint));
  const std::vector<int> all = Others({}, static_cast<int>(recordings.size()));
  TrainingLine line;
  SayWhenTrainingInterrupted(FLAGS_out);
  const TrainedRestoration trained = OrFail(TrainFromRecordings(
      recordings, all, options,
      [&line](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  LOG(INFO) << SizesText(trained.sizes);
  RestorationFile file = trained.file;
  file.training = TrainingJson(recordings, options.more, trained);
  const std::string title = NameOf(options.training.kind) + " restoration, " +
                            std::to_string(recordings.size()) + " recordings (" + FLAGS_setting +
                            ")";
  OrFail(WriteFileAtomically(in_out("curve.svg"), TrainingCurveSvg(trained.curve, title)));
  OrFail(WriteRestorationFile(FLAGS_out, file));
  const TrainingPoint& last = trained.curve.back();
  std::printf("%s: %zu points of the training curve, final held-out loss %s, %s s%s; %s\n",
              title.c_str(), trained.curve.size(), Rounded(last.validation_loss, 3).c_str(),
              Rounded(line.Seconds(), 3).c_str(),
              trained.resumed ? " (resumed from a checkpoint)" : "",
              in_out("restoration.json").c_str());
  return kDone;
}

// Adds the recordings of --more_settings, without those that are learnt from (and scored) anyway.
void AddMoreRecordings(const std::vector<Recording>& known, RestorationRunOptions* options) {
  if (FLAGS_more_settings.empty()) return;
  for (const Recording& recording : LoadBodiesOfSetting(FLAGS_more_settings)) {
    const bool is_known =
        std::any_of(known.begin(), known.end(),
                    [&recording](const Recording& other) { return other.id == recording.id; });
    if (!is_known) options->more.push_back(OrFail(MakeBodyRecording(recording)));
  }
}

int Run() {
  RestorationRunOptions options = OptionsFromCommandLine();
  if (FLAGS_check) return kDone;
  SetBlasThreads(options.training.num_threads);
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  CheckPushed(recordings);
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  CheckObservedFlag(PendulumsOf(bodies));
  AddMoreRecordings(recordings, &options);
  return FLAGS_crossvalidate > 0 ? CrossValidate(bodies, options) : Train(bodies, options);
}

}  // namespace

int main(int argc, char** argv) {
  pushid::RestartWithBlasOfProcessor(argv);
  return pushid::RunApp(argc, argv,
                        "pushid-train-restoration trains networks that make bodies of pendulums; "
                        "run again, it goes on.\n"
                        "  pushid-train-restoration --recordings=recordings/manifest.json "
                        "--model=model.json --out=restoration",
                        Run);
}
