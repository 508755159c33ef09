// apps: outputs of a formation, from flags to files.
#include "apps/formation_outputs.h"

#include <gflags/gflags.h>

#include <functional>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_files.h"
#include "ident/formations/formation_files.h"
#include "ident/generators/push_particles.h"

DEFINE_string(csv_out, "", "trajectories, one row per frame and person (CSV)");
DEFINE_string(trajectories_out, "", "trajectories of the hips (.txt)");
DEFINE_string(forces_out, "", "net forces, one row per frame, person and part (CSV)");
DEFINE_string(bvh_out, "", "folder for the pendulums as BVH, with manifest.json and the pushes");
DEFINE_string(svg_out, "", "picture of the wave (SVG): time across, person down, colour speed");
DEFINE_string(forces_svg_out, "", "picture of the net forces with their parts (SVG)");
DEFINE_bool(forces_own_scale, false, "with --forces_svg_out, give each panel its own scale");

DEFINE_string(generator, "",
              "whole bodies by diffusion instead of --restoration: the folder that "
              "pushid-train-generator --kind=diffusion --out wrote");
DEFINE_string(html_out, "", "page of the moving people (HTML)");
DEFINE_string(strip_out, "", "strip of poses (SVG)");
DEFINE_string(joints_out, "", "with bodies: joint positions (CSV)");
DEFINE_string(bodies_out, "",
              "with bodies: the bodies (BVH, one file per person, named after this one)");

namespace pushid {
namespace {

// Flags that go with one way to bodies, where that is not the one.
void CheckWayToBodies() {
  std::vector<FlagRule> rules = {
      {"restoration",
       FlagRule::kExcludes,
       {"generator"},
       "--restoration and --generator both make the bodies; give one of them"},
      {"postprocess",
       FlagRule::kExcludes,
       {"generator"},
       "--postprocess needs --restoration; a generator does its own postprocessing"}};
  for (const char* flag : DiffusionFlagNames()) {
    rules.push_back({flag, FlagRule::kNeeds, {"generator"}, ""});
  }
  for (const char* flag : {"joints_out", "bodies_out"}) {
    rules.push_back({flag,
                     FlagRule::kNeeds,
                     {"restoration", "generator"},
                     "--{} needs bodies: give the folder of pushid-train-restoration as "
                     "--restoration, or that of pushid-train-generator as --generator"});
  }
  CheckFlagRules(rules);
}

void CheckPicture(const std::string& flag, const std::string& file, int people, int most) {
  if (file.empty() || people <= most) return;
  throw Error{"--" + flag + " shows at most " + std::to_string(most) +
              " people; leave it out or lower --people"};
}

BodyScene SceneOfRun(const FormationRun& run) {
  BodyScene scene;
  scene.id = run.recording.id;
  scene.dt = run.recording.scene.dt;
  scene.subject_ids = run.recording.subject_ids;
  return scene;
}

LoadedGenerator LoadFormationGenerator(const DiffusionGeneratorOptions& diffusion,
                                       const Scene& scene) {
  GeneratorChanges changes;
  changes.diffusion = diffusion;
  LoadedGenerator loaded = OrFail(LoadGenerator(FLAGS_generator, changes, "--generator"));
  OrFail(PrepareForFormation(scene, "generator", &loaded));
  const std::string other = OtherPushKinds(loaded.settings, scene);
  if (!other.empty()) Warn(other);
  return loaded;
}

// A file that a flag names, or does not, and what writes it.
struct NamedOutput {
  std::string file;
  std::function<MaybeError(const std::string& file)> write;
};

// Up to the first that fails.
void WriteNamed(const std::vector<NamedOutput>& outputs) {
  for (const NamedOutput& output : outputs) {
    if (output.file.empty()) continue;
    OrFail(output.write(output.file));
  }
}

}  // namespace

void CheckOutputFlags(int people) {
  CheckPicture("svg_out", FLAGS_svg_out, people, kMostPeopleInWave);
  CheckPicture("forces_svg_out", FLAGS_forces_svg_out, people, kMostPeopleInForces);
  if (!FLAGS_trajectories_out.empty() && !EndsWith(FLAGS_trajectories_out, ".txt")) {
    throw Error{"--trajectories_out names " + FLAGS_trajectories_out +
                "; trajectories end in .txt"};
  }
  OrFail(CheckOutputFiles({FLAGS_agents_out, FLAGS_csv_out, FLAGS_trajectories_out,
                           FLAGS_forces_out, FLAGS_svg_out, FLAGS_forces_svg_out, FLAGS_html_out,
                           FLAGS_strip_out, FLAGS_joints_out, FLAGS_bodies_out}));
  if (!FLAGS_bvh_out.empty()) OrFail(CheckOutputFolder("bvh_out", FLAGS_bvh_out));
  CheckNeeds({"forces_own_scale"}, {"forces_svg_out"});
}

bool DrawsWave() { return !FLAGS_svg_out.empty(); }

FormationBodyFlags FormationBodyFlagsFromCommandLine() {
  const RestorationFlags restoration = RestorationFlagsFromCommandLine();
  CheckWayToBodies();
  const DiffusionGeneratorOptions diffusion = DiffusionOptionsFromCommandLine();
  return FormationBodyFlags{restoration, diffusion};
}

std::optional<FormationBodyPlan> PlanBodies(const FormationBodyFlags& flags,
                                            const std::vector<Pose>& first_poses, Scene* scene) {
  const bool generates = !FLAGS_generator.empty();
  if (!generates && !flags.restoration.given()) return std::nullopt;
  FormationBodyPlan plan;
  if (generates) {
    LoadedGenerator generator = LoadFormationGenerator(flags.diffusion, *scene);
    plan.generator = std::move(generator);
  } else {
    std::unique_ptr<Restoration> restoration =
        LoadFlaggedRestoration(flags.restoration, scene->num_people());
    plan.restoration = std::move(restoration);
  }
  plan.first_poses = first_poses.empty()
                         ? TakePoses({SyntheticPose(scene->people.front().body.rod_length)}, scene)
                         : first_poses;
  return plan;
}

void WriteOutputs(const FormationRun& run, const std::vector<OnsetBand>& onsets,
                  const std::string& title) {
  using File = const std::string&;
  const ForceScale scale = FLAGS_forces_own_scale ? ForceScale::kOwn : ForceScale::kShared;
  WriteNamed(
      {{FLAGS_bvh_out, [&](File file) { return WriteFormationRecording(file, run); }},
       {FLAGS_csv_out,
        [&](File file) { return WriteTrajectoryCsv(file, run.recording, run.prediction); }},
       {FLAGS_trajectories_out, [&](File file) { return WriteFormationTrajectories(file, run); }},
       {FLAGS_forces_out, [&](File file) { return WriteForcesCsv(file, run); }},
       {FLAGS_svg_out,
        [&](File file) { return WriteFileAtomically(file, WaveSvg(run, title, onsets)); }},
       {FLAGS_forces_svg_out,
        [&](File file) { return WriteFileAtomically(file, ForcesSvg(run, title, scale)); }}});
}

void WriteFormationBodies(const PostprocessOptions& postprocess,
                          const std::optional<FormationBodyPlan>& plan, const FormationRun& run,
                          const std::string& title) {
  const bool generates = plan && plan->generator;
  BodyScene scene = SceneOfRun(run);
  if (plan) {
    scene.bodies = OrFail(
        generates ? GeneratedBodies(run, plan->first_poses, *plan->generator)
                  : FormationBodies(run, plan->first_poses, *plan->restoration, postprocess));
  }
  Animation animation;
  animation.title = title + (generates ? "; bodies by diffusion" : "");
  animation.dt = scene.dt;
  // Restored bodies hang on their pendulums; generated ones move beside them.
  if (generates) AddForecast(scene.subject_ids, scene.bodies, &animation);
  AddPrediction(run.recording, run.prediction, generates ? std::vector<BodyMotion>() : scene.bodies,
                &animation);
  AddPushes(run.recording, &animation);
  animation.figures = FeetSvg(run);
  using File = const std::string&;
  WriteNamed({{FLAGS_html_out,
               [&](File file) { return WriteFileAtomically(file, AnimationHtml({animation})); }},
              {FLAGS_strip_out,
               [&](File file) {
                 return WriteFileAtomically(file, PoseStrip(animation, kPosesOfStrip).ToString());
               }},
              {FLAGS_joints_out, [&](File file) { return WriteJointsCsv(file, scene); }},
              {FLAGS_bodies_out, [&](File file) {
                 OrFail(WriteBodyBvh(file, scene));
                 return MaybeError();
               }}});
}

}  // namespace pushid
