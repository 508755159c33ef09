// apps: pushid-generate: motion continued by a learned generator, judged and shown: windows of
// motion capture, and recorded groups.
#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "datasets/loading/mocap_folder.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_files.h"
#include "ident/forecasts/forecast_scene.h"
#include "ident/forecasts/forecast_spread.h"
#include "ident/forecasts/social_report.h"
#include "ident/generators/generator_files.h"
#include "ident/generators/push_particles.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_json.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"
#include "ident/problem/parallel.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;

struct GenerateFlags {
  std::string model;   // folder of the generator
  std::string folder;  // of clips
  GeneratorChanges changes;
  ForecastProtocol protocol = ForecastProtocol::kValidation;
  int samples = 0;                 // futures of every window; 0: none
  uint64_t seed = 1;               // of the samples
  std::string action;              // of the window to show; empty: the first
  int window = 0;                  // which of the action's
  std::string id;                  // of the recording to show
  int observed = 0;                // frames shown to diffusion; 0: as it was made for
  int frames = 0;                  // of the shown motion in all; 0: as many as the recording
  std::string states, states_out;  // files of states of people; empty: none
  std::string physics;             // file of a model; empty: none
  int target_window = -1;          // whose end is the target of the path search; -1: none
  std::string json_out, poses_out, svg_out, html_out;

  bool Shows() const { return !poses_out.empty() || !svg_out.empty() || !html_out.empty(); }
};

// Poses of the strip.
inline constexpr int kStripPoses = 6;

const GenerateFlags kFlags;

}  // namespace

DEFINE_string(model, "", "folder that pushid-train-generator --out wrote");
DEFINE_string(folder, "",
              "particles: the folder of clips, with skeleton.json in it or in its parent");
DEFINE_string(
    protocol, pushid::NameOf(kFlags.protocol),
    "particles: windows to forecast: test (eight drawn per clip, from test/ if there is one), "
    "validation (from the last clip of every action) or all");
DEFINE_int32(
    samples, kFlags.samples,
    "particles: number of sampled futures per window, for coverage, CRPS, energy score and "
    "the fan in pictures; 0: none");
DEFINE_uint64(seed, kFlags.seed, "seed of the sampled futures");
DEFINE_int32(
    observed, kFlags.observed,
    "diffusion: number of observed frames, 1 for the first poses and the push; 0: as trained");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote, to blend with and to show");
DEFINE_int32(
    frames, kFlags.frames,
    "diffusion: length of the shown forecast, frames, also past the recording's end; 0: as "
    "long as the recording");
DEFINE_string(states, "",
              "diffusion: CSV of the states of people that somebody annotated "
              "(recording,frame,person,symbol), for SSCP and transitions; empty: built-in states");
DEFINE_string(csv_out, "", "diffusion: write the states of the recordings here (CSV)");
DEFINE_string(action, "", "particles: action of the window to show; empty: the first");
DEFINE_int32(window, kFlags.window, "particles: which of the action's windows to show, from 0 on");
DEFINE_string(id, "", "diffusion: the recording to show");
DEFINE_int32(
    target_window, kFlags.target_window,
    "particles, --samples: show the most probable of them that ends like this window of the "
    "action; -1: none");
DEFINE_string(json_out, "", "write the errors here (JSON)");
DEFINE_string(poses_out, "",
              "write observed, recorded and forecast poses here (.csv), or observed "
              "and forecast ones (.bvh)");
DEFINE_string(svg_out, "", "a strip of poses (SVG)");
DEFINE_string(html_out, "", "a page with the forecast over the recorded motion (HTML)");
DEFINE_string(sampler, pushid::NameOf(kFlags.changes.diffusion.sampler),
              "diffusion: sampler: renoised or ddpm");
DEFINE_int32(steps, kFlags.changes.diffusion.steps, "diffusion: number of sampling steps");
DEFINE_double(blend, kFlags.changes.diffusion.blend,
              "diffusion: blend of the hip paths, from 0 (forecast) to 1 (physics)");
DEFINE_string(without, "",
              "particles: parts of the forecast that are left out, comma-separated: ridge, simlpe "
              "(of the blend), bones (keeping their lengths)");

namespace {

using Json = nlohmann::ordered_json;

void ReadChanges(GeneratorChanges* changes) {
  DiffusionGeneratorOptions& diffusion = changes->diffusion;
  OrFail(ParseName("--sampler", FLAGS_sampler, &diffusion.sampler));
  TakeInRange("steps", FLAGS_steps, 1, kDiffusionTime, &diffusion.steps);
  TakeInRange("blend", FLAGS_blend, 0.0, 1.0, &diffusion.blend);
  for (const std::string& part : SplitList(FLAGS_without)) {
    if (part == "ridge") {
      changes->ridge = false;
    } else if (part == "simlpe") {
      changes->simlpe = false;
    } else if (part == "bones") {
      changes->particles.project_bones = false;
    } else {
      throw Error{"--without names '" + part + "'; it must list ridge, simlpe or bones"};
    }
  }
}

// The forecast of a network by itself, on the windows of the tables; samples as in the paper.
void SetPublished(GenerateFlags* flags) {
  const std::string paper = PublishedFromCommandLine();
  if (paper == "sde") {
    if (!Given("protocol")) flags->protocol = ForecastProtocol::kTest;
    flags->changes.particles.project_bones = false;
    flags->changes.particles.noise_memory = 0.0;
  } else if (paper == "sdm") {
    DiffusionGeneratorOptions& sdm = flags->changes.diffusion;
    if (!Given("sampler")) sdm.sampler = DiffusionSampler::kDdpm;
    if (!Given("steps")) sdm.steps = kDiffusionTime;
    sdm.averaged = 8;
    sdm.mirrored = false;
    sdm.settle = Settling::kNone;
  }
}

void ReadNumbers(GenerateFlags* flags) {
  if (FLAGS_samples != 0) CheckRange("samples", FLAGS_samples, kLeastSamples, 10000);
  TakeInRange("window", FLAGS_window, 0, 1e9, &flags->window);
  TakeInRange("target_window", FLAGS_target_window, -1, 1e9, &flags->target_window);
  TakeInRange("observed", FLAGS_observed, 0, 1000, &flags->observed);
  TakeInRange("frames", FLAGS_frames, 0, 10000, &flags->frames);
  OrFail(CheckPosesPath("--poses_out", FLAGS_poses_out));
  if (flags->target_window >= 0 && FLAGS_samples == 0) {
    throw Error{"--target_window needs --samples, among which it looks"};
  }
}

// Errors: flags that say something to generators of the other kind alone, or that this kind needs.
void CheckKindFlags(const GenerateFlags& flags, GeneratorKind kind) {
  const bool groups = RowOf(kind).groups;
  std::vector<const char*> foreign = {"folder",        "action",  "window", "protocol",
                                      "target_window", "without", "samples"};
  if (!groups) {
    foreign = {"recordings", "setting", "id",      "observed", "physics", "frames",
               "states",     "csv_out", "sampler", "steps",    "blend"};
  }
  for (const char* flag : foreign) {
    if (!Given(flag)) continue;
    throw Error{std::string("--") + flag + " has no effect on a generator of " + NameOf(kind),
                FLAGS_model};
  }
  if (!groups) return Require("folder", FLAGS_folder, "name the folder of the clips");
  if (flags.Shows()) Require("id", FLAGS_id, "name the recording to show");
  if (flags.changes.diffusion.blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the model to blend with"};
  }
  CheckRecordingFlags();
}

GenerateFlags GenerateFlagsFromCommandLine() {
  GenerateFlags flags;
  Require("model", FLAGS_model, "name the folder that pushid-train-generator --out wrote");
  OrFail(ParseName("--protocol", FLAGS_protocol, &flags.protocol));
  ReadNumbers(&flags);
  ReadChanges(&flags.changes);
  SetPublished(&flags);
  flags.model = FLAGS_model;
  flags.folder = FLAGS_folder;
  flags.changes.seed = FLAGS_seed;
  flags.physics = FLAGS_physics;
  flags.states = FLAGS_states;
  flags.states_out = FLAGS_csv_out;
  flags.samples = FLAGS_samples;
  flags.seed = FLAGS_seed;
  flags.action = FLAGS_action;
  flags.id = FLAGS_id;
  flags.json_out = FLAGS_json_out;
  flags.poses_out = FLAGS_poses_out;
  flags.svg_out = FLAGS_svg_out;
  flags.html_out = FLAGS_html_out;
  OrFail(CheckOutputFiles(
      {flags.json_out, flags.poses_out, flags.svg_out, flags.html_out, flags.states_out}));
  return flags;
}

// Windows of clips forecast, sampled and shown, and paths to a pose.

// Windows are forecast together, in batches that fit the memory.
constexpr size_t kTogether = 64;
constexpr double kTargetDistance = 0.05;  // m; what counts as near the target of a path

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
                                                const std::vector<ForecastWindow>& windows,
                                                const GenerateFlags& flags) {
  Random random(flags.seed);
  const NormalSource normal = [&random] { return random.Normal(); };
  ProgressLine line;
  std::vector<std::vector<SampledFuture>> all;
  for (const ForecastWindow& window : windows) {
    all.push_back(
        generator.Sample({{window.observed}}, kForecastFrames, flags.samples, normal).front());
    line.Show("sampling futures: window " + std::to_string(all.size()) + " of " +
              std::to_string(windows.size()));
  }
  line.Finish();
  return all;
}

// The windows of one action, all of the first where none is named.
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

// The scene's forecast becomes the most probable path to the target; its outcome goes to `json`.
void SearchPath(const GenerateFlags& flags, const Eigen::VectorXf& target, ForecastScene* scene,
                Json* json) {
  scene->title += ", towards the end of window " + std::to_string(flags.target_window);
  const PathChoice choice =
      OrFail(MostProbablePath(scene->futures, target, kTargetDistance, scene->layout));
  (*json)["path"] = {{"future", choice.future + 1},
                     {"near", choice.near},
                     {"distance_m", choice.distance},
                     {"log_likelihood", choice.log_likelihood}};
  std::printf("%d of %d futures end near window %d; the most probable is the %d., %s m from it\n",
              choice.near, flags.samples, flags.target_window, choice.future + 1,
              Rounded(choice.distance, 3).c_str());
  scene->forecast = scene->futures[choice.future].motion;
}

// The window's forecast and futures; of a search its outcome goes to `json`.
ForecastScene SceneOfWindow(const LoadedGenerator& loaded, const GenerateFlags& flags,
                            const std::vector<ForecastWindow>& windows, Json* json) {
  const size_t at = FindWindow(windows, flags.action, flags.window);
  const ForecastWindow& window = windows[at];
  ForecastScene scene;
  scene.dt = 1.0 / loaded.settings.rate;
  scene.layout = loaded.settings.layout;
  scene.title = window.action + ", window " + std::to_string(flags.window);
  scene.observed = window.observed;
  scene.recorded = window.future;
  scene.forecast = loaded.generator->Forecast({{window.observed}}, kForecastFrames).front();
  if (flags.samples > 0) {
    Random random(flags.seed);
    const NormalSource normal = [&random] { return random.Normal(); };
    scene.futures =
        loaded.generator->Sample({{window.observed}}, kForecastFrames, flags.samples, normal)
            .front();
  }
  if (flags.target_window < 0) return scene;
  const size_t target = FindWindow(windows, flags.action, flags.target_window);
  const Eigen::VectorXf end = windows[target].future.rightCols(1);
  SearchPath(flags, end, &scene, json);
  return scene;
}

// Writes the files of --poses_out, --svg_out and --html_out; their names go to stdout.
void ShowForecast(const ForecastScene& scene, const GenerateFlags& flags) {
  if (!flags.poses_out.empty()) {
    const auto files = OrFail(WritePoses(flags.poses_out, scene));
    for (const std::string& file : files) std::printf("%s\n", file.c_str());
  }
  const auto write = [](const std::string& file, const std::string& content) {
    OrFail(WriteFileAtomically(file, content));
    std::printf("%s\n", file.c_str());
  };
  if (!flags.svg_out.empty()) write(flags.svg_out, ForecastStripSvg(scene, kStripPoses));
  if (!flags.html_out.empty()) write(flags.html_out, ForecastPageHtml(scene));
}

int GenerateFromClips(const LoadedGenerator& loaded, const GenerateFlags& flags) {
  const MocapFolder mocap = OrFail(ReadMocapFolder(flags.folder));
  const ParticleLayout& layout = loaded.settings.layout;
  if (mocap.skeleton.layout.names != layout.names) {
    return Fail(Error{"these clips have " + std::to_string(mocap.skeleton.layout.num_particles()) +
                          " particles, which are not the " +
                          std::to_string(layout.num_particles()) + " particles of the generator",
                      flags.folder});
  }
  const auto windows =
      MakeForecastWindows(mocap, flags.protocol, flags.protocol == ForecastProtocol::kAll ? 8 : 0);
  if (windows.empty()) {
    return Fail(
        Error{"no clip of --protocol=" + NameOf(flags.protocol) + " is long enough for a window",
              flags.folder});
  }
  const double before = Now();
  const std::vector<Trajectories> forecasts = Forecasts(*loaded.generator, windows);
  const double per_window = (Now() - before) / static_cast<double>(windows.size());
  std::vector<std::vector<SampledFuture>> samples;
  if (flags.samples > 0 && flags.target_window < 0) {
    samples = Samples(*loaded.generator, windows, flags);
  }
  const ForecastScores scores = ScoresOf(windows, forecasts, layout, samples);
  std::printf("%s", ForecastScoresText(scores).c_str());
  Json json = ResultHead("pushid-forecasts/1");
  json.update(ToJson(scores));
  json["baselines"]["zero_velocity"] = ToJson(ScoresOf(windows, ZeroVelocity(windows), layout));
  if (flags.Shows() || flags.target_window >= 0) {
    const ForecastScene scene = SceneOfWindow(loaded, flags, windows, &json);
    ShowForecast(scene, flags);
  }
  json["run"] = {{"seconds_per_window", per_window}};
  if (flags.json_out.empty()) return kDone;
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

// Groups forecast and shown.

Prediction PredictBeside(const LoadedGenerator& loaded, const IdentifiedModel& physics,
                         const BodyRecording& recording, int frames) {
  const Prediction predicted =
      OrFail(PredictFrom(physics, recording.pendulum, ShownToPhysics(loaded.settings), frames));
  if (predicted.status.ok) return predicted;
  throw Error{"recording " + recording.pendulum.id + ": " + OutsideText(predicted.status) +
                  "; leave out --physics",
              physics.source};
}

// The hips that physics predict; none without physics.
GroupHips HipsBeside(const LoadedGenerator& loaded, const std::optional<IdentifiedModel>& physics,
                     const BodyRecording& recording, int frames) {
  if (!physics) return GroupHips();
  return PendulumHips(recording, PredictBeside(loaded, *physics, recording, frames));
}

std::vector<std::string> WriteGroup(const std::string& path, const BodyScene& scene) {
  if (IsBodyFile(path)) return OrFail(WriteBodyBvh(path, scene));
  OrFail(WriteJointsCsv(path, scene));
  return {path};
}

// The model of --physics; nothing where none is named.
std::optional<IdentifiedModel> LoadPhysics(const std::string& file) {
  if (file.empty()) return std::nullopt;
  IdentifiedModel model = ModelOf(OrFail(ReadFittedModel(file)).fit);
  model.source = file;
  return model;
}

// A recording's forecast by a generator of any kind, to its end or for `frames` frames in all;
// the generator gets physics that see as many frames.
std::vector<BodyMotion> GenerateWith(const LoadedGenerator& loaded, const BodyRecording& recording,
                                     const std::optional<IdentifiedModel>& physics,
                                     int frames = 0) {
  const GroupHips hips = HipsBeside(loaded, physics, recording, frames);
  return OrFail(GenerateBodies(loaded.settings, *loaded.generator, recording, hips, frames));
}

// The states of --states, or the built-in ones; writes --csv_out.
SocialCues FlaggedCues(const GenerateFlags& flags, const std::vector<BodyRecording>& recordings) {
  SocialCues cues;
  if (!flags.states.empty()) {
    const StateTable table = OrFail(ReadStates(flags.states));
    std::vector<std::string> ids;
    for (const ManifestRecording& entry : FlaggedManifest().value().recordings) {
      ids.push_back(entry.id);
    }
    cues = OrFail(SocialCuesOf(table, ids, recordings));
  }
  if (flags.states_out.empty()) return cues;
  OrFail(WriteStates(flags.states_out, StatesInUse(recordings, cues)));
  return cues;
}

// Writes the files of --poses_out, --svg_out and --html_out: everybody recorded, forecast, and
// beside them the pendulums of the physics; the page shows the figures too. Returns the files'
// names.
std::vector<std::string> ShowGroup(const LoadedGenerator& loaded, const GenerateFlags& flags,
                                   const BodyRecording& recording,
                                   const std::optional<IdentifiedModel>& physics,
                                   const std::vector<std::string>& figures) {
  const auto bodies = GenerateWith(loaded, recording, physics, flags.frames);
  Animation animation;
  animation.title = recording.pendulum.id + ", " + NameOf(loaded.kind);
  animation.dt = recording.pendulum.scene.dt;
  AddRecorded(recording.pendulum, recording.bodies, &animation);
  AddForecast(recording.pendulum.subject_ids, bodies, &animation);
  AddPushes(recording.pendulum, &animation);
  animation.figures = figures;
  if (physics) {
    const Prediction predicted = PredictBeside(loaded, *physics, recording, flags.frames);
    AddPrediction(recording.pendulum, predicted, {}, &animation);
  }
  std::vector<std::string> files;
  if (!flags.poses_out.empty()) {
    files = WriteGroup(flags.poses_out, SceneOf(recording, bodies));
  }
  if (!flags.svg_out.empty()) {
    OrFail(WriteFileAtomically(flags.svg_out, PoseStrip(animation, kStripPoses).ToString()));
    files.push_back(flags.svg_out);
  }
  if (!flags.html_out.empty()) {
    OrFail(WriteFileAtomically(flags.html_out, AnimationHtml({animation})));
    files.push_back(flags.html_out);
  }
  return files;
}

// Once for all recordings whose pushes are of such kinds.
void WarnOfPushKinds(const GeneratorSettings& settings,
                     const std::vector<BodyRecording>& recordings) {
  std::set<std::string> told;
  for (const BodyRecording& recording : recordings) {
    const std::string other = OtherPushKinds(settings, recording.pendulum.scene);
    if (!other.empty() && told.insert(other).second) LOG(WARNING) << other;
  }
}

int FromGroups(const LoadedGenerator& loaded, const GenerateFlags& flags) {
  const std::optional<IdentifiedModel> physics = LoadPhysics(flags.physics);
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  BodyScores scores;
  const BodyRecording* shown = nullptr;
  for (const BodyRecording& recording : bodies) {
    if (recording.pendulum.id == flags.id) shown = &recording;
  }
  if (flags.Shows() && shown == nullptr) {
    return Fail(Error{"--id is '" + flags.id + "', which is not one of the recordings"});
  }
  WarnOfPushKinds(loaded.settings, bodies);
  const SocialCues cues = FlaggedCues(flags, bodies);
  double seconds = 0.0;
  for (const BodyRecording& recording : bodies) {
    const double before = Now();
    const auto generated = GenerateWith(loaded, recording, physics);
    seconds += (Now() - before) / static_cast<double>(bodies.size());
    const int observed = loaded.settings.observed, seen = SeenByBaselines(observed);
    const auto score = [&](const char* name, const std::vector<BodyMotion>& forecast) {
      scores[name].push_back(ScoreBodies(recording, forecast, observed));
    };
    score("generator", generated);
    if (observed > 1) {
      scores["generator_all_frames"].push_back(ScoreBodies(recording, generated));
    }
    score("static", StaticBodies(recording, seen));
    score("constant_velocity", ConstantVelocityBodies(recording, seen));
  }
  BodyEvaluation evaluation = SummarizeAll(bodies, scores);
  const std::optional<SocialReport> social = CompareSocially(bodies, cues, &evaluation);
  std::printf("%s\n%s", BodyText(evaluation).c_str(), TimedErrorsText(evaluation).c_str());
  if (social) std::printf("\n%s", SocialText(*social).c_str());
  if (flags.Shows()) {
    const std::vector<std::string> figures =
        social ? SocialFigures(*social, "generator") : std::vector<std::string>();
    for (const std::string& file : ShowGroup(loaded, flags, *shown, physics, figures)) {
      std::printf("%s\n", file.c_str());
    }
  }
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(evaluation, &json);
  if (social) json["social"] = ToJson(*social);
  if (flags.json_out.empty()) return kDone;
  json["run"] = {{"seconds_per_recording", seconds}};
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

int Run() {
  const GenerateFlags flags = GenerateFlagsFromCommandLine();
  LoadedGenerator loaded = OrFail(LoadGenerator(flags.model, flags.changes));
  CheckKindFlags(flags, loaded.kind);
  if (flags.observed > 0) loaded.settings.observed = flags.observed;
  return RowOf(loaded.kind).groups ? FromGroups(loaded, flags) : GenerateFromClips(loaded, flags);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-generate continues observed motion with a learned generator and "
                        "reports the error against the recording.\n\n"
                        "  pushid-generate --model=generator --folder=cmu_mocap "
                        "--protocol=validation --json_out=errors.json",
                        Run);
}
