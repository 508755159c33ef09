// apps: bodies of formations, from poses to files.
#include "apps/simulate_formation_bodies.h"

#include "apps/flags/command_line.h"
#include "datasets/files/atomic_file.h"
#include "datasets/loading/load_recordings.h"
#include "ident/bodies/animation.h"
#include "ident/bodies/body_files.h"
#include "ident/generators/push_particles.h"

namespace pushid {
namespace {

constexpr int kPosesOfStrip = 6;

Result<std::vector<Pose>> FirstPosesFrom(const std::string& manifest, double rod_length) {
  if (manifest.empty()) return std::vector<Pose>{SyntheticPose(rod_length)};
  LoadOptions options;
  options.keep_all_joints = true;
  const Result<std::vector<Recording>> recordings = LoadRecordings(manifest, options);
  if (!recordings.ok()) return recordings.error();
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), SkeletonMapping::kExact);
  if (!bodies.ok()) return bodies.error();
  return FirstPoses(bodies.value());
}

BodyScene SceneOfRun(const FormationRun& run, std::vector<BodyMotion> bodies) {
  BodyScene scene;
  scene.id = run.recording.id;
  scene.dt = run.recording.scene.dt;
  scene.subject_ids = run.recording.subject_ids;
  scene.bodies = std::move(bodies);
  return scene;
}

Result<LoadedGenerator> LoadFormationGenerator(const FormationBodyFlags& flags, bool rod_moves,
                                               const Scene& scene) {
  if (MaybeError error = CheckRod("generator", rod_moves)) return *error;
  GeneratorChanges changes;
  changes.diffusion = flags.diffusion;
  Result<LoadedGenerator> loaded = LoadGenerator(flags.generator, changes, "--generator");
  if (!loaded.ok()) return loaded;
  if (MaybeError error = PrepareForFormation(scene, "generator", &loaded.value())) return *error;
  const std::string other = OtherPushKinds(loaded.value().settings, scene);
  if (!other.empty()) Warn(other);
  return loaded;
}

MaybeError WritePages(const FormationBodyFlags& flags, const Animation& animation) {
  MaybeError error;
  if (!flags.html_out.empty()) {
    error = WriteFileAtomically(flags.html_out, AnimationHtml(animation));
  }
  if (!error && !flags.strip_out.empty()) {
    error = WriteFileAtomically(flags.strip_out, PoseStripSvg(animation, kPosesOfStrip));
  }
  return error;
}

}  // namespace

Result<std::optional<FormationBodyPlan>> PlanBodies(const FormationBodyFlags& flags, bool rod_moves,
                                                    Scene* scene) {
  if (!flags.given()) return std::optional<FormationBodyPlan>();
  FormationBodyPlan plan;
  if (flags.generates()) {
    Result<LoadedGenerator> generator = LoadFormationGenerator(flags, rod_moves, *scene);
    if (!generator.ok()) return generator.error();
    plan.generator = std::move(generator.value());
  } else {
    Result<std::unique_ptr<Restoration>> restoration =
        LoadFlaggedRestoration(flags.restoration, rod_moves, scene->num_people());
    if (!restoration.ok()) return restoration.error();
    plan.restoration = std::move(restoration.value());
  }
  const Result<std::vector<Pose>> poses =
      FirstPosesFrom(flags.poses_from, scene->people.front().body.rod_length);
  if (!poses.ok()) return poses.error();
  plan.first_poses = TakePoses(poses.value(), scene);
  return std::optional<FormationBodyPlan>(std::move(plan));
}

MaybeError WriteFormationPendulums(const FormationBodyFlags& flags, const FormationRun& run,
                                   const std::string& title) {
  Animation animation;
  animation.title = title;
  animation.dt = run.recording.scene.dt;
  AddPrediction(run.recording, run.prediction, {}, &animation);
  AddPushes(run.recording, &animation);
  return WritePages(flags, animation);
}

MaybeError WriteFormationBodies(const FormationBodyFlags& flags, const FormationBodyPlan& plan,
                                const FormationRun& run, const std::string& title) {
  Result<std::vector<BodyMotion>> bodies =
      plan.generator ? GeneratedBodies(run, plan.first_poses, *plan.generator)
                     : FormationBodies(run, plan.first_poses, *plan.restoration,
                                       flags.restoration.postprocess);
  if (!bodies.ok()) return bodies.error();
  const BodyScene scene = SceneOfRun(run, std::move(bodies.value()));
  Animation animation;
  animation.title = title + (plan.generator ? "; bodies by diffusion" : "");
  animation.dt = scene.dt;
  // Restored bodies hang on their pendulums; generated ones move beside them.
  if (plan.generator) AddForecast(scene.subject_ids, scene.bodies, &animation);
  AddPrediction(run.recording, run.prediction,
                plan.generator ? std::vector<BodyMotion>() : scene.bodies, &animation);
  AddPushes(run.recording, &animation);
  MaybeError error = WritePages(flags, animation);
  if (!error && !flags.joints_out.empty()) error = WriteJointsCsv(flags.joints_out, scene);
  if (!error && !flags.bodies_out.empty()) {
    const auto files = WriteBodyFiles(flags.bodies_out, scene);
    if (!files.ok()) error = files.error();
  }
  return error;
}

}  // namespace pushid
