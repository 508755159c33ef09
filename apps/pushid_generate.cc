// apps: pushid-generate: motion continued by a learned generator, judged and shown.
#include <gflags/gflags.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/generate.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/forecasts/forecast_scene.h"
#include "ident/forecasts/forecast_spread.h"
#include "ident/generators/push_particles.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/parallel.h"
#include "ident/validation/scores_report.h"

namespace {
const pushid::GenerateFlags kFlags;
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

using namespace pushid;
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
  if (flags.target_window >= 0 && flags.samples == 0) {
    throw Error{"--target_window needs --samples, among which it looks"};
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

// Once for all recordings whose pushes are of such kinds.
void WarnOfPushKinds(const GeneratorSettings& settings,
                     const std::vector<BodyRecording>& recordings) {
  std::set<std::string> told;
  for (const BodyRecording& recording : recordings) {
    const std::string other = OtherPushKinds(settings, recording.pendulum.scene);
    if (!other.empty() && told.insert(other).second) Warn(other);
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
