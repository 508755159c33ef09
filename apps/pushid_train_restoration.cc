// apps: pushid-train-restoration: networks that predict bodies from pendulums.
#include "apps/flags/command_line.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/postprocess_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/training_flags.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/restoration_files.h"
#include "ident/model/model_json.h"

namespace {

using namespace pushid;

const RestorationTrainingOptions kOptions;
const std::string kKind = KindHelp("restoration", kRestorationKinds,
                                   [](const RestorationKindRow& row) { return row.trained; });

}  // namespace

DEFINE_string(model, "", "model that pushid-fit --model_out wrote: the pendulum to fit");
DEFINE_string(kind, pushid::NameOf(kOptions.kind), kKind.c_str());
DEFINE_string(coordinates, pushid::NameOf(kOptions.coordinates),
              "cvae: joints relative to the rod's tip (tip), or to the hip at frame 0 (ldp)");
DEFINE_string(
    sees, pushid::NameOf(kOptions.view),
    "inputs: the person's pendulum (pendulum), also those of the neighbours "
    "(neighbours, window only), or no pendulum, for comparison (pose: window uses the first "
    "pose and the push, cvae the previous pose)");
DEFINE_bool(halves, kOptions.halves,
            "cvae: a network for the lower and one for the upper body (false: one for both)");
DEFINE_string(
    training, pushid::NameOf(kOptions.training),
    "cvae: pushid's training (own), or as published: Adam at 1e-4 (autoencoders: falling to "
    "1e-7), sigma compared, the latent variable drawn, no predicted pendulums (published)");
DEFINE_bool(check, false, "only check the flags: nothing is read, trained or written");
DEFINE_double(effort, kOptions.effort, "factor on the number of training steps");
DEFINE_string(more_settings, "",
              "also train the bodies on the recorded pendulums of these settings (named as in "
              "--setting); they are neither fitted nor scored");
namespace {

// Throws if a flag has no effect on the kind.
void CheckKind(RestorationKind kind, RestorationView view) {
  if (view == RestorationView::kNeighbours && !RowOf(kind).sees_neighbours) {
    throw Error{"--sees=neighbours needs --kind=window"};
  }
  const bool chain = kind == RestorationKind::kCvae;
  if (!chain && Given("halves")) throw Error{"--nohalves needs --kind=cvae"};
  if (!chain && Given("training")) throw Error{"--training needs --kind=cvae"};
  if (Given("coordinates") && (!chain || view == RestorationView::kPose)) {
    throw Error{
        "--coordinates needs --kind=cvae --sees=pendulum: without a pendulum there is no tip"};
  }
}

// Reads all flags but the model's.
void ReadOptions(RestorationRunOptions* options) {
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
  const auto kind = FromName<RestorationKind>(FLAGS_kind);
  if (!kind || !RowOf(*kind).trained) {
    throw Error{"--kind is '" + FLAGS_kind + "'; it must be " + Listed(TrainedKinds(), "or")};
  }
  RestorationTrainingOptions& training = options->training;
  training.kind = *kind;
  OrFail(ParseName("--coordinates", FLAGS_coordinates, &training.coordinates));
  OrFail(ParseName("--sees", FLAGS_sees, &training.view));
  OrFail(ParseName("--training", FLAGS_training, &training.training));
  CheckKind(*kind, training.view);
  FoldsFromCommandLine();  // throws where flags contradict each other
  if (Given("forecast")) {
    throw Error{"--forecast: restorations always use both forecasters; leave it out"};
  }
  options->observed = ObservedFrames();
  if (options->observed > 0 && FLAGS_crossvalidate == 0) {
    throw Error{"--observed needs --crossvalidate: training uses whole recordings"};
  }
  if (!(FLAGS_effort > 0.0 && FLAGS_effort <= 100.0)) {
    throw Error{"--effort must lie above 0 and not above 100"};
  }
  if (FLAGS_num_threads < 1) throw Error{"--num_threads must be positive"};
  training.halves = FLAGS_halves;
  training.effort = FLAGS_effort;
  training.seed = FLAGS_seed;
  training.num_threads = FLAGS_num_threads;
}

// Reads the fit's options from the model too, unless flags are only checked.
RestorationRunOptions OptionsFromCommandLine() {
  RestorationRunOptions options;
  ReadOptions(&options);
  options.postprocess = PostprocessFromCommandLine();
  if (FLAGS_check) return options;
  options.fit = OrFail(ReadFittedModel(FLAGS_model)).fit.options;
  options.fit.num_threads = FLAGS_num_threads;
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  return options;
}

int Train(const std::vector<BodyRecording>& recordings, const RestorationRunOptions& options) {
  MakeOut();
  const std::vector<int> all = Others({}, static_cast<int>(recordings.size()));
  TrainingLine line;
  const TrainedRestoration trained = OrFail(TrainFromRecordings(
      recordings, all, options,
      [&line](const std::string& step, double done) { line.Show(step, done); }));
  line.Finish();
  int most = 0;
  const auto see = [&most](const std::vector<BodyRecording>& seen) {
    for (const BodyRecording& recording : seen) most = std::max(most, recording.num_people());
  };
  see(recordings), see(options.more);
  nlohmann::ordered_json training = TrainingJson("recordings", JsonOfData(recordings));
  training[kMostPeopleKey] = most;
  std::string sizes;
  for (const NetworkSize& size : trained.sizes) {
    training["parameters"][size.name] = size.parameters;
    sizes += size.name + ": " + std::to_string(size.parameters) + " parameters";
    if (size.released > 0) sizes += " (release: " + std::to_string(size.released) + ")";
    sizes += "\n";
  }
  LOG(INFO) << sizes;
  training["curve"] = CurveJson(trained.curve);
  TensorFolder content = trained.content;
  content.training = training;
  const std::string title = NameOf(options.training.kind) + " restoration, " +
                            std::to_string(recordings.size()) + " recordings (" + FLAGS_setting +
                            ")";
  OrFail(WriteTensorFolder(kRestorationFolder, FLAGS_out, content));
  std::printf("%s: %zu points of the training curve, final held-out loss %s, %s s; %s\n",
              title.c_str(), trained.curve.size(),
              Rounded(trained.curve.back().validation_loss, 3).c_str(),
              Rounded(line.Seconds(), 3).c_str(), InOut("restoration.json").c_str());
  return kDone;
}

// Adds the recordings of --more_settings that are not in --setting.
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
  if (FLAGS_crossvalidate == 0) return Train(bodies, options);
  return ScoreFolds([&](const RunProgress& progress) {
    return CrossValidateChain(bodies, options, FoldsFromCommandLine(), progress);
  });
}

}  // namespace

int main(int argc, char** argv) {
  pushid::RestartWithBlasOfProcessor(argv);
  return pushid::RunApp(argc, argv,
                        "pushid-train-restoration trains networks that predict bodies from "
                        "pendulums.\n"
                        "  pushid-train-restoration --recordings=recordings/manifest.json "
                        "--model=model.json --out=restoration",
                        Run);
}
