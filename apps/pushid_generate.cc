// apps: pushid-generate: forecasts by a learned generator, scored and displayed: windows of motion
// capture clips, and recorded groups.
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/published_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/json_file.h"
#include "datasets/files/random.h"
#include "datasets/loading/generator_data.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/forecasts/forecast_scene.h"
#include "ident/forecasts/forecast_spread.h"
#include "ident/forecasts/social_report.h"
#include "ident/generators/generator_files.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_json.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/parallel.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;

// Options that depend on several flags.
struct GenerateOptions {
  GeneratorChanges changes;
  int scored_samples = 1;  // of every group, each scored separately
  ForecastProtocol protocol = ForecastProtocol::kValidation;
};

const GenerateOptions kOptions;

}  // namespace

DEFINE_string(model, "", "folder that pushid-train-generator --out wrote");
DEFINE_string(folder, "",
              "particles: the folder of clips, with skeleton.json in it or in its parent");
DEFINE_string(
    protocol, pushid::NameOf(kOptions.protocol),
    "particles: windows to forecast: test (eight drawn per clip of test/ or of subject 5), "
    "validation (from the last clip of every action) or all");
DEFINE_int32(
    samples, 0,
    "particles: number of sampled futures per window, for coverage, CRPS, energy score and "
    "the fan in pictures; 0: none");
DEFINE_uint64(seed, 1, "seed of the sampled futures");
DEFINE_int32(
    observed, 0,
    "diffusion: number of observed frames, 1 for the first poses and the push; 0: as trained");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote, to blend with and to show");
DEFINE_int32(
    frames, 0,
    "diffusion: length of the shown forecast, frames, also past the recording's end; 0: as "
    "long as the recording");
DEFINE_string(
    states, "",
    "diffusion: CSV of annotated states of people (recording,frame,person,symbol), for SSCP "
    "and transitions; empty: built-in states");
DEFINE_string(csv_out, "", "diffusion: write the states of the recordings here (CSV)");
DEFINE_string(action, "", "particles: action of the window to show; empty: the first");
DEFINE_int32(window, 0, "particles: which of the action's windows to show, from 0 on");
DEFINE_string(id, "", "diffusion: the recording to show");
DEFINE_int32(
    target_window, -1,
    "particles, --samples: show the most probable sampled future that ends like this window of the "
    "action; -1: none");
DEFINE_string(json_out, "", "write the errors here (JSON)");
DEFINE_string(poses_out, "",
              "particles: write observed, recorded and forecast poses here (CSV); diffusion: write "
              "the forecast bodies here (.csv or .bvh)");
DEFINE_string(html_out, "", "a page with the forecast over the recorded motion (HTML)");
DEFINE_int32(steps, kOptions.changes.diffusion.steps, "diffusion: number of sampling steps");
DEFINE_double(blend, kOptions.changes.diffusion.blend,
              "diffusion: blend of the hip paths, from 0 (forecast) to 1 (physics)");
DEFINE_string(without, "",
              "particles: parts of the forecast that are left out, comma-separated: ridge, simlpe "
              "(of the blend), bones (keeping their lengths)");

namespace {

using Json = nlohmann::ordered_json;

bool Shows() { return !FLAGS_poses_out.empty() || !FLAGS_html_out.empty(); }

void ReadChanges(GeneratorChanges* changes) {
  DiffusionGeneratorOptions& diffusion = changes->diffusion;
  TakeInRange("steps", FLAGS_steps, 1, kDiffusionTime, &diffusion.steps);
  TakeInRange("blend", FLAGS_blend, 0.0, 1.0, &diffusion.blend);
  const std::map<std::string, bool*> without = {{"ridge", &changes->ridge},
                                                {"simlpe", &changes->simlpe},
                                                {"bones", &changes->particles.project_bones}};
  for (const std::string& part : SplitList(FLAGS_without)) {
    if (without.count(part) == 0) {
      throw Error{"--without names '" + part + "'; it must list ridge, simlpe or bones"};
    }
    *without.at(part) = false;
  }
}

// The settings of --published: a network alone, on the paper's windows, with the paper's sampling.
void SetPublished(GenerateOptions* options) {
  const std::optional<GeneratorKind> published = PublishedKind();
  if (published == GeneratorKind::kParticles) {
    if (!Given("protocol")) options->protocol = ForecastProtocol::kTest;
    options->changes.particles.project_bones = false;
  } else if (published == GeneratorKind::kDiffusion) {
    DiffusionGeneratorOptions& sdm = options->changes.diffusion;
    if (!Given("steps")) sdm.steps = kDiffusionTime;
    options->scored_samples = sdm.averaged;
    sdm.averaged = 1;
    sdm.settle = false;
    sdm.postprocess = {false, 0, false, false};
  }
}

void CheckNumbers() {
  if (FLAGS_samples != 0) CheckRange("samples", FLAGS_samples, kLeastSamples, 10000);
  CheckRange("window", FLAGS_window, 0, 1e9);
  CheckRange("target_window", FLAGS_target_window, -1, 1e9);
  CheckRange("observed", FLAGS_observed, 0, 1000);
  CheckRange("frames", FLAGS_frames, 0, 10000);
  if (FLAGS_target_window >= 0 && FLAGS_samples == 0) {
    throw Error{"--target_window needs --samples, from which it selects"};
  }
}

// Throws if a flag has no effect on this kind, or one that it needs is missing.
void CheckKindFlags(const GenerateOptions& options, GeneratorKind kind) {
  const bool groups = RowOf(kind).groups;
  std::vector<std::string> foreign = {"folder",        "action",  "window", "protocol",
                                      "target_window", "without", "samples"};
  if (!groups) {
    foreign = {"recordings", "setting", "id",      "observed", "physics",
               "frames",     "states",  "csv_out", "steps",    "blend"};
  }
  if (PublishedKind().value_or(kind) != kind) foreign.push_back("published");
  RefuseGiven(foreign, " has no effect on a generator of " + NameOf(kind), FLAGS_model);
  const std::string& poses = FLAGS_poses_out;
  const bool is_csv = std::filesystem::path(poses).extension() == ".csv";
  if (!poses.empty() && !is_csv && !(groups && IsBodyFile(poses))) {
    throw Error{"--poses_out is '" + poses + "'; it must end in .csv" + (groups ? " or .bvh" : "")};
  }
  if (!groups) return Require("folder", FLAGS_folder, "name the folder of the clips");
  if (Shows()) Require("id", FLAGS_id, "name the recording to show");
  if (options.changes.diffusion.blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the model to blend with"};
  }
  CheckRecordingFlags();
}

GenerateOptions OptionsFromCommandLine() {
  GenerateOptions options;
  Require("model", FLAGS_model, "name the folder that pushid-train-generator --out wrote");
  OrFail(ParseName("--protocol", FLAGS_protocol, &options.protocol));
  CheckNumbers();
  ReadChanges(&options.changes);
  SetPublished(&options);
  options.changes.seed = FLAGS_seed;
  OrFail(CheckOutputFiles({FLAGS_json_out, FLAGS_poses_out, FLAGS_html_out, FLAGS_csv_out}));
  return options;
}

// Windows of clips.

constexpr size_t kTogether = 64;          // windows in one call, limited by memory
constexpr double kTargetDistance = 0.05;  // m; largest distance of a path's end from its target

std::vector<Trajectories> Forecasts(const MotionGenerator& generator,
                                    const std::vector<ForecastWindow>& windows) {
  std::vector<Trajectories> all;
  for (size_t i = 0; i < windows.size(); i += kTogether) {
    std::vector<ObservedMotion> people;
    for (size_t k = i; k < std::min(i + kTogether, windows.size()); ++k) {
      people.push_back({windows[k].observed});
    }
    for (Trajectories& motion : generator.Forecast(people, kForecastFrames)) {
      all.push_back(std::move(motion));
    }
  }
  return all;
}

std::vector<std::vector<SampledFuture>> Samples(const MotionGenerator& generator,
                                                const std::vector<ForecastWindow>& windows) {
  Random random(FLAGS_seed);
  const NormalSource normal = [&random] { return random.Normal(); };
  ProgressLine line;
  std::vector<std::vector<SampledFuture>> all;
  for (const ForecastWindow& window : windows) {
    all.push_back(
        generator.Sample({{window.observed}}, kForecastFrames, FLAGS_samples, normal).front());
    line.OfJobs("sampling futures: window")(static_cast<int>(all.size()),
                                            static_cast<int>(windows.size()));
  }
  line.Finish();
  return all;
}

// Index of the window with this number among those of an action (empty: the first action).
size_t FindWindow(const std::vector<ForecastWindow>& windows, const std::string& action,
                  int number) {
  int found = 0;
  std::string of = action.empty() ? windows.front().action : action;
  for (size_t i = 0; i < windows.size(); ++i) {
    if (windows[i].action == of && found++ == number) return i;
  }
  throw Error{"there are " + std::to_string(found) + " windows of " + Quoted(of) +
              "; --window and --target_window count from 0"};
}

// Replaces the scene's forecast by the most probable path to the target, which `json` describes.
void SearchPath(const Eigen::VectorXf& target, ForecastScene* scene, Json* json) {
  scene->title += ", towards the end of window " + std::to_string(FLAGS_target_window);
  const PathChoice choice =
      OrFail(MostProbablePath(scene->futures, target, kTargetDistance, scene->layout));
  (*json)["path"] = {{"future", choice.future + 1},
                     {"near", choice.near},
                     {"distance_m", choice.distance},
                     {"log_likelihood", choice.log_likelihood}};
  std::printf("%d of %d futures end near window %d; the most probable is the %d., %s m from it\n",
              choice.near, FLAGS_samples, FLAGS_target_window, choice.future + 1,
              Rounded(choice.distance, 3).c_str());
  scene->forecast = scene->futures[choice.future].motion;
}

// The window's forecast and futures, with SearchPath if --target_window is given.
ForecastScene SceneOfWindow(const MotionGenerator& generator,
                            const std::vector<ForecastWindow>& windows, Json* json) {
  const size_t at = FindWindow(windows, FLAGS_action, FLAGS_window);
  const ForecastWindow& window = windows[at];
  ForecastScene scene;
  scene.dt = 1.0 / kForecastRate;
  scene.layout = generator.layout();
  scene.title = window.action + ", window " + std::to_string(FLAGS_window);
  scene.observed = window.observed;
  scene.recorded = window.future;
  scene.forecast = generator.Forecast({{window.observed}}, kForecastFrames).front();
  if (FLAGS_samples > 0) scene.futures = Samples(generator, {window}).front();
  if (FLAGS_target_window < 0) return scene;
  const size_t target = FindWindow(windows, FLAGS_action, FLAGS_target_window);
  const Eigen::VectorXf end = windows[target].future.rightCols(1);
  SearchPath(end, &scene, json);
  return scene;
}

// Writes --html_out, and prints the names of all files.
void Show(std::vector<std::string> files, const Animation& page) {
  if (!FLAGS_html_out.empty()) {
    OrFail(WriteFileAtomically(FLAGS_html_out, AnimationHtml({page})));
    files.push_back(FLAGS_html_out);
  }
  for (const std::string& file : files) std::printf("%s\n", file.c_str());
}

void ShowWindow(const ForecastScene& scene) {
  std::vector<std::string> files;
  if (!FLAGS_poses_out.empty()) {
    OrFail(WriteForecastCsv(FLAGS_poses_out, scene));
    files = {FLAGS_poses_out};
  }
  Show(files, ToAnimation(scene));
}

int FromClips(const TrainedNetworks& trained, const GenerateOptions& options) {
  const auto generator = trained.Make(options.changes);
  const MocapFolder mocap = OrFail(ReadMocapFolder(FLAGS_folder));
  const ParticleLayout& layout = generator->layout();
  if (mocap.skeleton.layout.names != layout.names) {
    return Fail(Error{"these clips have " + std::to_string(mocap.skeleton.layout.num_particles()) +
                          " particles, which are not the " +
                          std::to_string(layout.num_particles()) + " particles of the generator",
                      FLAGS_folder});
  }
  const auto windows = MakeForecastWindows(mocap, options.protocol,
                                           options.protocol == ForecastProtocol::kAll ? 8 : 0);
  if (windows.empty()) {
    return Fail(Error{"there is no clip of --protocol=" + NameOf(options.protocol) +
                          " that is long enough for a window",
                      FLAGS_folder});
  }
  const double before = Now();
  const std::vector<Trajectories> forecasts = Forecasts(*generator, windows);
  const double per_window = (Now() - before) / static_cast<double>(windows.size());
  std::vector<std::vector<SampledFuture>> samples;
  if (FLAGS_samples > 0 && FLAGS_target_window < 0) samples = Samples(*generator, windows);
  const ForecastScores scores = ScoresOf(windows, forecasts, layout, samples);
  std::printf("%s", ForecastScoresText(scores).c_str());
  Json json = ResultHead("pushid-forecasts/1");
  json.update(ToJson(scores));
  json["baselines"]["zero_velocity"] = ToJson(ScoresOf(windows, ZeroVelocity(windows), layout));
  if (Shows() || FLAGS_target_window >= 0) {
    ShowWindow(SceneOfWindow(*generator, windows, &json));
  }
  json["run"] = {{"seconds_per_window", per_window}};
  WriteIfNamed(FLAGS_json_out, json);
  return kDone;
}

// Groups.

// The model of --physics, if given.
std::optional<IdentifiedModel> LoadPhysics() {
  if (FLAGS_physics.empty()) return std::nullopt;
  IdentifiedModel model = ModelOf(OrFail(ReadFittedModel(FLAGS_physics)).fit);
  model.source = FLAGS_physics;
  return model;
}

// The states of --states, or the built-in ones. Writes --csv_out.
SocialCues FlaggedCues(const std::vector<BodyRecording>& recordings) {
  SocialCues cues;
  if (!FLAGS_states.empty()) {
    const StateTable table = OrFail(ReadStates(FLAGS_states));
    std::vector<std::string> ids;
    for (const ManifestRecording& entry : FlaggedManifest().value().recordings) {
      ids.push_back(entry.id);
    }
    cues = OrFail(SocialCuesOf(table, ids, recordings));
  }
  if (FLAGS_csv_out.empty()) return cues;
  OrFail(WriteStates(FLAGS_csv_out, StatesInUse(recordings, cues)));
  return cues;
}

// Writes the forecast of a recording as files and as a page with the recorded bodies, the pendulums
// of the physics and the figures.
void ShowGroup(const GeneratorSettings& settings, const TrainedNetworks& trained,
               const GenerateOptions& options, const BodyRecording& recording,
               const std::optional<IdentifiedModel>& physics,
               const std::vector<std::string>& figures) {
  const auto bodies = OrFail(GenerateBodies(settings, *trained.Make(options.changes), recording,
                                            physics ? &*physics : nullptr, FLAGS_frames));
  Animation animation;
  animation.title = recording.pendulum.id + ", " + NameOf(trained.kind());
  animation.dt = recording.pendulum.scene.dt;
  AddRecorded(recording.pendulum, recording.bodies, &animation);
  AddForecast(recording.pendulum.subject_ids, bodies, &animation);
  AddPushes(recording.pendulum, &animation);
  animation.figures = figures;
  if (physics) {
    const Prediction predicted = OrFail(PredictBeside(settings, *physics, recording, FLAGS_frames));
    AddPrediction(recording.pendulum, predicted, {}, &animation);
  }
  std::vector<std::string> files;
  const std::string& poses = FLAGS_poses_out;
  const BodyScene scene = SceneOf(recording, bodies);
  if (IsBodyFile(poses)) {
    files = OrFail(WriteBodyBvh(poses, scene));
  } else if (!poses.empty()) {
    OrFail(WriteJointsCsv(poses, scene));
    files = {poses};
  }
  Show(files, animation);
}

// Warns once of push kinds that the training did not have.
void WarnOfPushKinds(const GeneratorSettings& settings,
                     const std::vector<BodyRecording>& recordings) {
  std::set<std::string> told;
  for (const BodyRecording& recording : recordings) {
    const std::string other = OtherPushKinds(settings, recording.pendulum.scene);
    if (!other.empty() && told.insert(other).second) LOG(WARNING) << other;
  }
}

// Scores of one generator and of the baselines.
BodyScores ScoreGroups(const GeneratorSettings& settings, const MotionGenerator& generator,
                       const std::vector<BodyRecording>& bodies,
                       const std::optional<IdentifiedModel>& physics, double* seconds) {
  BodyScores scores;
  for (const BodyRecording& recording : bodies) {
    const double before = Now();
    const auto generated =
        OrFail(GenerateBodies(settings, generator, recording, physics ? &*physics : nullptr));
    *seconds += (Now() - before) / static_cast<double>(bodies.size());
    ScoreForecast(recording, generated, settings.observed, &scores);
  }
  return scores;
}

int FromGroups(const TrainedNetworks& trained, const GenerateOptions& options) {
  const std::optional<IdentifiedModel> physics = LoadPhysics();
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  const BodyRecording* shown = nullptr;
  for (const BodyRecording& recording : bodies) {
    if (recording.pendulum.id == FLAGS_id) shown = &recording;
  }
  if (Shows() && shown == nullptr) {
    return Fail(Error{"--id is '" + FLAGS_id + "', which is not one of the recordings"});
  }
  GeneratorSettings settings = trained.settings;
  if (FLAGS_observed > 0) settings.observed = FLAGS_observed;
  WarnOfPushKinds(settings, bodies);
  const SocialCues cues = FlaggedCues(bodies);
  double seconds = 0.0;
  std::vector<Json> samples;
  GeneratorChanges changes = options.changes;
  for (int k = 0; k < options.scored_samples; ++k, ++changes.seed) {
    BodyEvaluation evaluation = SummarizeAll(
        bodies, ScoreGroups(settings, *trained.Make(changes), bodies, physics, &seconds));
    const std::optional<SocialReport> social = CompareSocially(bodies, cues, &evaluation);
    AddBodyJson(evaluation, &samples.emplace_back());
    if (social) samples.back()["social"] = ToJson(*social);
    if (k > 0) continue;
    if (options.scored_samples > 1) std::printf("the first sample of each recording\n");
    std::printf("%s\n%s", BodyText(evaluation).c_str(), TimedErrorsText(evaluation).c_str());
    if (social) std::printf("\n%s", SocialText(*social).c_str());
    if (!Shows()) continue;
    ShowGroup(settings, trained, options, *shown, physics,
              social ? SocialFigures(*social, "generator") : std::vector<std::string>());
  }
  Json json = ResultHead(kScoresSchema);
  json.update(MeanOfSamples(samples));
  if (options.scored_samples > 1) {
    std::printf(
        "\n%d samples, each scored, in the mean: %s\n", options.scored_samples,
        MetricsText(kBodyMetrics, OrFail(MeanMetrics(json, kBodyMetrics, FLAGS_model)), 3).c_str());
  }
  if (FLAGS_json_out.empty()) return kDone;
  json["run"] = {{"seconds_per_recording", seconds}};
  OrFail(WriteJson(FLAGS_json_out, json));
  return kDone;
}

int Run() {
  const GenerateOptions options = OptionsFromCommandLine();
  const TrainedNetworks trained = OrFail(ReadGenerator(FLAGS_model));
  CheckKindFlags(options, trained.kind());
  return RowOf(trained.kind()).groups ? FromGroups(trained, options) : FromClips(trained, options);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-generate continues observed motion by a learned generator, and measures its errors.\n"
      "  pushid-generate --model=generator --folder=cmu_mocap --protocol=validation "
      "--json_out=errors.json",
      Run);
}
