// apps: pushid-generate by flag.
#include "apps/flags/generate_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/names.h"
#include "ident/forecasts/forecast_scene.h"
#include "ident/forecasts/forecast_spread.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::GenerateFlags kFlags;
}  // namespace

DEFINE_string(model, "", "folder that pushid-train-generator --out wrote");
DEFINE_string(dataset, pushid::NameOf(kFlags.data),
              "what to forecast: cmu (motion-capture clips in --folder) or pushes (--recordings, "
              "which implies it)");
DEFINE_string(folder, "", "cmu: the folder of clips, with skeleton.json in it or in its parent");
DEFINE_string(protocol, pushid::NameOf(kFlags.protocol),
              "cmu: windows to forecast: test (eight drawn per clip, from test/ if there is one), "
              "validation (from the last clip of every action) or all");
DEFINE_int32(stride, kFlags.stride,
             "cmu: frames from one window's start to the next (validation, all); 0: 8 in clips of "
             "more than a thousand windows, otherwise 2");
DEFINE_int32(
    samples, kFlags.samples,
    "number of sampled futures per window, for coverage, CRPS, energy score and the fan in "
    "pictures; for groups by diffusion, for how often the recorded hips lie among them; 0: none");
DEFINE_uint64(seed, kFlags.seed, "seed of the sampled futures");
DEFINE_int32(
    observed, kFlags.observed,
    "diffusion: number of observed frames, 1 for the first poses and the push; 0: as trained");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote, to blend with and to show");
DEFINE_int32(frames, kFlags.frames,
             "diffusion: length of the forecast, frames, also past the recording's end; a table "
             "shows the motion of all groups second by second; 0: as long as the recording");
DEFINE_string(states, "",
              "diffusion: CSV of the states of people and groups that somebody annotated "
              "(recording,frame,person,symbol), for SSCP and transitions; empty: built-in states");
DEFINE_string(states_out, "", "diffusion: write the states of the recordings here (CSV)");
DEFINE_string(action, "", "cmu: action of the window to show; empty: the first");
DEFINE_int32(window, kFlags.window, "cmu: which of the action's windows to show, from 0 on");
DEFINE_string(id, "", "pushes: the recording to show");
DEFINE_int32(person, kFlags.person, "pushes, particles: which person of the recording");
DEFINE_int32(target_window, kFlags.target_window,
             "cmu: show the most probable path that ends like this window of the action: with "
             "--samples among those, otherwise by minimization; -1: no search");
DEFINE_double(target_distance, kFlags.target_distance,
              "--target_window with --samples: largest mean distance of the joints that counts as "
              "reaching it, m");
DEFINE_string(json_out, "", "write the errors here (JSON)");
DEFINE_string(poses_out, "",
              "write observed, recorded and forecast poses here (.csv), or observed "
              "and forecast ones (.bvh)");
DEFINE_string(strip_out, "", "a strip of poses (SVG)");
DEFINE_string(page_out, "", "a page with the forecast over the recorded motion (HTML)");
DEFINE_int32(poses, kFlags.poses, "poses of the strip");

namespace pushid {
namespace {

// The forecast of a network by itself, on the windows of the tables.
const std::vector<PublishedFlags> kPublishedForecast = {{"sde",
                                                         {{"protocol", "test"},
                                                          {"project_bones", "false"},
                                                          {"noise_memory", "0"},
                                                          {"correlated_noise", "false"}}},
                                                        {"sdm",
                                                         {{"sampler", "ddpm"},
                                                          {"sampling_steps", "1000"},
                                                          {"averaged", "8"},
                                                          {"mirrored_samples", "false"},
                                                          {"settle", "none"}}}};

void ReadNumbers(GenerateFlags* flags) {
  if (FLAGS_samples != 0) CheckRange("samples", FLAGS_samples, kLeastSamples, 10000);
  TakeInRange("stride", FLAGS_stride, 0, 1e6, &flags->stride);
  TakeInRange("window", FLAGS_window, 0, 1e9, &flags->window);
  TakeInRange("person", FLAGS_person, 0, 1e6, &flags->person);
  TakeInRange("poses", FLAGS_poses, 2, 40, &flags->poses);
  TakeInRange("target_window", FLAGS_target_window, -1, 1e9, &flags->target_window);
  TakeInRange("target_distance", FLAGS_target_distance, 0.0, 100.0, &flags->target_distance);
  TakeInRange("observed", FLAGS_observed, 0, 1000, &flags->observed);
  TakeInRange("frames", FLAGS_frames, 0, 10000, &flags->frames);
  OrFail(CheckPosesPath("--poses_out", FLAGS_poses_out));
}

void CheckData(const GenerateFlags& flags) {
  if (flags.data == GeneratorData::kCmu) {
    for (const char* flag : {"id", "person", "recordings", "setting"}) {
      if (Given(flag)) throw Error{std::string("--") + flag + " needs --dataset=pushes"};
    }
    if (Given("target_distance") && (flags.target_window < 0 || flags.samples == 0)) {
      throw Error{"--target_distance needs --samples and --target_window"};
    }
    Require("folder", FLAGS_folder, "name the folder of the clips");
    return;
  }
  for (const char* flag :
       {"folder", "action", "window", "protocol", "stride", "target_window", "target_distance"}) {
    if (Given(flag)) throw Error{std::string("--") + flag + " needs --dataset=cmu"};
  }
  if (flags.Shows()) Require("id", FLAGS_id, "name the recording to show");
  if (Given("push_spread") && flags.samples == 0) {
    throw Error{"--push_spread needs --samples"};
  }
  if (flags.changes.diffusion.blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the model to blend with"};
  }
  CheckRecordingFlags();
}

}  // namespace

void CheckKindFlags(const GenerateFlags& flags, GeneratorKind kind) {
  const GeneratorKindRow& row = RowOf(kind);
  if (flags.data == GeneratorData::kPushes && !row.groups && flags.samples > 0 && !flags.Shows()) {
    throw Error{"with pushes and " + NameOf(kind) +
                ", --samples only adds a fan to --poses_out, --strip_out or --page_out; give one "
                "of them"};
  }
  std::vector<const char*> foreign;
  for (const auto& other : KindFlags<GenerateFlags>::ForeignTo(kind)) foreign.push_back(other.flag);
  if (row.groups) foreign.push_back("person");
  if (!row.groups) foreign.insert(foreign.end(), {"physics", "frames", "states", "states_out"});
  if (!row.any_observed) foreign.push_back("observed");
  if (!row.futures) foreign.insert(foreign.end(), {"samples", "target_window"});
  for (const char* flag : foreign) {
    if (!Given(flag)) continue;
    throw Error{std::string("--") + flag + " has no effect on a generator of " + NameOf(kind),
                FLAGS_model};
  }
}

GenerateFlags GenerateFlagsFromCommandLine() {
  TakePublished(kPublishedForecast);
  GenerateFlags flags;
  Require("model", FLAGS_model, "name the folder that pushid-train-generator --out wrote");
  OrFail(ParseName("--dataset", FLAGS_dataset, &flags.data));
  OrFail(ParseName("--protocol", FLAGS_protocol, &flags.protocol));
  ReadNumbers(&flags);
  KindFlags<GenerateFlags>::ReadAll(&flags);
  if (!Given("dataset") && Given("recordings")) flags.data = GeneratorData::kPushes;
  flags.model = FLAGS_model;
  flags.folder = FLAGS_folder;
  flags.changes.seed = FLAGS_seed;
  flags.physics = FLAGS_physics;
  flags.states = FLAGS_states;
  flags.states_out = FLAGS_states_out;
  flags.samples = FLAGS_samples;
  flags.seed = FLAGS_seed;
  flags.action = FLAGS_action;
  flags.id = FLAGS_id;
  flags.json_out = FLAGS_json_out;
  flags.poses_out = FLAGS_poses_out;
  flags.strip_out = FLAGS_strip_out;
  flags.page_out = FLAGS_page_out;
  CheckData(flags);
  OrFail(CheckOutputFiles(
      {flags.json_out, flags.poses_out, flags.strip_out, flags.page_out, flags.states_out}));
  return flags;
}

}  // namespace pushid
