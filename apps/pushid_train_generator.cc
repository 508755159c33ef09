// apps: pushid-train-generator: learned generators of motion.
#include <functional>

#include "apps/flags/command_line.h"
#include "apps/flags/published_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/training_flags.h"
#include "datasets/files/json_file.h"
#include "ident/model/model_json.h"
#include "ident/training/generator_training.h"

namespace {

using namespace pushid;

// Options that depend on several flags.
struct TrainGeneratorFlags {
  GeneratorTrainingOptions options;
  bool hold_out = true;  // compute a held-out loss, on validation clips or a share of recordings
  int phases = 2;        // 1: only every second frame of a clip, as in the protocol
  GeneratorValidationOptions validation;
};

const TrainGeneratorFlags kFlags;
const pushid::GeneratorTrainingOptions kOptions;
const std::string kKind = KindHelp("generator", kGeneratorKinds, [](const auto&) { return true; });
}  // namespace

DEFINE_string(kind, pushid::NameOf(kOptions.kind), kKind.c_str());
DEFINE_string(folder, "",
              "particles: the folder of motion-capture clips, with skeleton.json and train/");
DEFINE_bool(
    hold_out, kFlags.hold_out,
    "hold out the validation clips, or 15 % of the recordings, for the training curve; off, the "
    "default of --published: train on all of them");
DEFINE_int32(
    observed, 1,
    "diffusion: number of observed frames in use and in scoring; 1: the first poses and the "
    "push");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote; its pendulum is refitted to the "
              "training recordings, for --blend");
DEFINE_double(
    blend, kFlags.validation.changes.diffusion.blend,
    "diffusion, --crossvalidate: blend of the hip paths, from 0 (forecast) to 1 (pendulum)");
DEFINE_int32(seeds, 0,
             "number of networks of different seeds that are averaged; 0: default of the kind");
DEFINE_int32(steps, 0, "training steps (particles: of the drift) per seed; 0: default of the kind");
DEFINE_int32(batch, 0,
             "batch size of a step: windows, or groups of people; 0: default of the kind");
DEFINE_int32(noise_steps, kOptions.particles.noise_steps,
             "particles: training steps of the noise; 0: do not learn noise");
DEFINE_int32(simlpe_steps, kOptions.simlpe.steps,
             "particles: training steps of the siMLPe that is blended with");
DEFINE_string(pooling, pushid::NameOf(kOptions.diffusion.structure.pooling),
              "diffusion: interaction between people: local (by distance, ahead and behind), none; "
              "mean_all (the default of --published=sdm) and heads (attention) as in SDM");
DEFINE_string(
    without, "",
    "--published=sde: parts to leave out, comma-separated: particles (input and output are poses), "
    "operator (the output is a pose), gru (an LSTM instead), noise (and Eq. 6), draw (Eq. 6 with "
    "its "
    "determinant instead), bones (Eq. 11), critic (Eq. 12), protocol (also train on the frames "
    "between those of the protocol, but not on the last clip of every action)");
namespace {

// The settings of Lyu et al., ACM MM 2021: particles alone, f and g trained together by Eq. 6 as
// printed, Eq. 10-12, one GRU. The weights of the losses were chosen here, because the paper's are
// not for metres.
void SetSde(TrainGeneratorFlags* flags) {
  GeneratorTrainingOptions* options = &flags->options;
  flags->phases = 1;
  options->correction = false;
  options->ridge_share = options->simlpe_share = 0.0;
  ParticleTrainingOptions& sde = options->particles;
  sde.batch = 32;
  sde.constant_rate = sde.even_frames = sde.together = true;
  sde.structure.poses = sde.structure.skip = false;
  sde.structure.noisy_input = true;
  sde.jitter = sde.mirrored = sde.distance = 0.0;
  sde.noise_loss = NoiseLoss::kDrawn;
  sde.squared = 10.0;
  sde.bones = 1.0;
  sde.critic = 0.001;
  const std::map<std::string, std::function<void()>> without = {
      {"particles",
       [&] {
         sde.structure.particles = sde.structure.summed = false;
         sde.structure.poses = true;
       }},
      {"operator", [&] { sde.structure.summed = false; }},
      {"gru", [&] { sde.structure.lstm = true; }},
      {"noise",
       [&] {
         sde.together = sde.structure.noisy_input = false;
         sde.noise_steps = 0;
         sde.noise_loss = NoiseLoss::kLikelihood;  // of --noise_steps
       }},
      {"draw", [&] { sde.noise_loss = NoiseLoss::kLikelihood; }},
      {"bones", [&] { sde.bones = 0.0; }},
      {"critic", [&] { sde.critic = 0.0; }},
      {"protocol", [&] { flags->phases = 2, flags->hold_out = true; }}};
  for (const std::string& part : SplitList(FLAGS_without)) {
    if (without.count(part) == 0) {
      throw Error{
          "--without names '" + part +
          "'; it must list particles, operator, gru, noise, draw, bones, critic or protocol"};
    }
    without.at(part)();
  }
}

// The settings of Tanke et al., ICCV 2023.
void SetSdm(DiffusionTrainingOptions* sdm) {
  sdm->steps = 1500;
  sdm->groups = 8;
  sdm->structure = {SocialPooling::kMeanAll, SocialJoin::kBottleneck, MotionFrame::kOwn};
  sdm->joint_weight = sdm->difference_weight = sdm->bystanders = 0.0;
  sdm->mirrored = sdm->turn = sdm->size = 0.0;
  sdm->observed_weight = 1.0;
}

void ReadPublished(TrainGeneratorFlags* flags) {
  GeneratorTrainingOptions* options = &flags->options;
  const std::optional<GeneratorKind> kind = PublishedKind();
  if (kind != GeneratorKind::kParticles && Given("without")) {
    throw Error{"--without needs --published=sde"};
  }
  if (!kind) return;
  const std::string paper = RowOf(*kind).paper;
  if (Given("kind") && options->kind != *kind) {
    throw Error{"--published=" + paper + " needs --kind=" + NameOf(*kind)};
  }
  if (FLAGS_crossvalidate > 0) {
    throw Error{"--crossvalidate needs pushid's own settings; leave out --published=" + paper};
  }
  options->kind = *kind;
  options->seeds = 1;
  flags->hold_out = false;
  if (*kind == GeneratorKind::kParticles) SetSde(flags);
  if (*kind == GeneratorKind::kDiffusion) SetSdm(&options->diffusion);
}

void ReadNumbers(TrainGeneratorFlags* flags) {
  GeneratorTrainingOptions& options = flags->options;
  CheckRange("seeds", FLAGS_seeds, 0, 20);
  CheckRange("steps", FLAGS_steps, 0, 1e6);
  CheckRange("batch", FLAGS_batch, 0, 4096);
  CheckRange("observed", FLAGS_observed, 1, 1000);
  TakeInRange("blend", FLAGS_blend, 0.0, 1.0, &flags->validation.changes.diffusion.blend);
  TakeInRange("num_threads", FLAGS_num_threads, 1, 1024, &options.num_threads);
  TakeInRange("simlpe_steps", FLAGS_simlpe_steps, 1, 1e6, &options.simlpe.steps);
  CheckRange("noise_steps", FLAGS_noise_steps, 0, 1e6);
  if (Given("noise_steps")) {
    if (options.particles.together) {
      throw Error{"--published=sde trains the noise with the drift; leave out --noise_steps"};
    }
    options.particles.noise_steps = FLAGS_noise_steps;
  }
  if (FLAGS_seeds > 0) options.seeds = FLAGS_seeds;
  if (FLAGS_steps > 0) options.particles.steps = options.diffusion.steps = FLAGS_steps;
  if (FLAGS_batch > 0) {
    options.particles.batch = options.simlpe.batch = options.diffusion.groups = FLAGS_batch;
  }
  if (Given("pooling")) {
    OrFail(ParseName("--pooling", FLAGS_pooling, &options.diffusion.structure.pooling));
  }
}

// Refuses flags that have no effect on this kind.
void CheckKind(const GeneratorKindRow& kind) {
  if (kind.groups) {
    RefuseGiven({"folder", "noise_steps", "simlpe_steps"},
                " needs --kind=" + NameOf(GeneratorKind::kParticles));
  } else {
    RefuseGiven(
        {"recordings", "setting", "observed", "crossvalidate", "physics", "blend", "pooling"},
        " needs --kind=" + KindsOfGroups());
    Require("folder", FLAGS_folder, "name the folder of the clips");
  }
  if (FLAGS_crossvalidate == 0) RefuseGiven({"blend", "physics"}, " needs --crossvalidate");
  if (FLAGS_blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the pendulum's model"};
  }
  if (FLAGS_blend == 0.0 && !FLAGS_physics.empty()) {
    throw Error{"--physics does nothing without --blend; give --blend=0.5"};
  }
  if (kind.groups) CheckRecordingFlags();
}

TrainGeneratorFlags TrainGeneratorFlagsFromCommandLine() {
  TrainGeneratorFlags flags;
  GeneratorTrainingOptions& options = flags.options;
  OrFail(ParseName("--kind", FLAGS_kind, &options.kind));
  options.seeds = RowOf(options.kind).seeds;
  ReadPublished(&flags);
  ReadNumbers(&flags);
  CheckKind(RowOf(options.kind));
  static_cast<FoldChoice&>(flags.validation) = FoldsFromCommandLine();
  flags.validation.observed = FLAGS_observed;
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  if (Given("hold_out")) flags.hold_out = FLAGS_hold_out;
  options.seed = FLAGS_seed;
  if (FLAGS_physics.empty()) return flags;
  const FittedModel physics = OrFail(ReadFittedModel(FLAGS_physics));
  flags.validation.physics = physics.fit.options;
  flags.validation.physics->num_threads = FLAGS_num_threads;
  return flags;
}

using Json = nlohmann::ordered_json;

// data: the clips or recordings, by name and hash.
int Train(TrainGeneratorFlags flags, const GeneratorSamples& samples, const Json& data) {
  SetForData(samples, &flags.options);
  MakeOut();
  TrainingLine line;
  TrainedGenerator trained =
      OrFail(TrainGenerator(samples, flags.options, [&](const TrainingPoint& point, double done) {
        line.Show(point.stage + ", step " + std::to_string(point.epoch), done);
      }));
  line.Finish();
  Json training = TrainingJson("data", data);
  training["curve"] = CurveJson(trained.curve);
  trained.networks.settings.training = training;
  const std::string title =
      NameOf(flags.options.kind) + ", " + std::to_string(data.size()) + " motions";
  OrFail(WriteGenerator(FLAGS_out, trained.networks));
  std::printf("%s: %d seeds, %s s; %s\n", title.c_str(), flags.options.seeds,
              Rounded(line.Seconds(), 3).c_str(), InOut("generator.json").c_str());
  return kDone;
}

constexpr double kHeldOut = 0.15;  // share of the recordings for the held-out loss

int FromClips(const TrainGeneratorFlags& flags) {
  const MocapFolder mocap = OrFail(ReadMocapFolder(FLAGS_folder));
  Json data = Json::array();
  for (const MocapClip& clip : mocap.clips) {
    if (clip.is_test) continue;
    data.push_back({{"clip", clip.name}, {"content_hash", clip.content_hash}});
  }
  return Train(flags, SamplesOf(mocap, !flags.hold_out, flags.phases), data);
}

int FromGroups(const TrainGeneratorFlags& flags) {
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  if (flags.validation.physics) CheckPushed(recordings);  // groups move without a push too
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  if (FLAGS_crossvalidate > 0) {
    return ScoreFolds([&](const RunProgress& progress) {
      return CrossValidateGenerator(bodies, flags.options, flags.validation, progress);
    });
  }
  const std::vector<int> all = Others({}, static_cast<int>(bodies.size()));
  std::vector<int> learnt = all, held;
  if (flags.hold_out && all.size() > 1) {
    SplitHeldOut(PendulumsOf(bodies), all, kHeldOut, flags.options.seed, &learnt, &held);
  }
  return Train(flags, SamplesOf(bodies, learnt, held, FLAGS_observed), JsonOfData(bodies));
}

int Run() {
  const TrainGeneratorFlags flags = TrainGeneratorFlagsFromCommandLine();
  SetBlasThreads(flags.options.num_threads);
  return RowOf(flags.options.kind).groups ? FromGroups(flags) : FromClips(flags);
}

}  // namespace

int main(int argc, char** argv) {
  pushid::RestartWithBlasOfProcessor(argv);
  return pushid::RunApp(argc, argv,
                        "pushid-train-generator trains networks that continue observed motion.\n"
                        "  pushid-train-generator --folder=cmu_mocap --out=generator",
                        Run);
}
