// apps: bodies of formations from flags to files.
#include "apps/flags/formation_bodies_flags.h"

#include "apps/flags/formation_flags.h"
#include "apps/flags/restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/loading/load_recordings.h"
#include "ident/bodies/animation.h"

DEFINE_string(poses_from, "",
              "formation with --restoration: manifest.json of recordings whose first poses (with "
              "skeleton and lean, in their order) the people take (default: the synthetic "
              "skeleton, upright)");
DEFINE_string(html_out, "", "formation with --restoration: page of the moving bodies (HTML)");
DEFINE_string(strip_out, "", "formation with --restoration: strip of poses (SVG)");
DEFINE_string(joints_out, "", "formation with --restoration: joint positions (CSV)");
DEFINE_string(bodies_out, "",
              "formation with --restoration: the bodies (BVH; one file a person, named after "
              "this one)");

namespace pushid {
namespace {

constexpr int kPosesOfStrip = 6;

Result<std::vector<Pose>> Poses(double rod_length) {
  if (FLAGS_poses_from.empty()) return std::vector<Pose>{SyntheticPose(rod_length)};
  LoadOptions options;
  options.keep_all_joints = true;
  const Result<std::vector<Recording>> recordings = LoadRecordings(FLAGS_poses_from, options);
  if (!recordings.ok()) return recordings.error();
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), SkeletonMapping::kExact);
  if (!bodies.ok()) return bodies.error();
  return FirstPoses(bodies.value());
}

BodyScene SceneOf(const FormationRun& run, std::vector<BodyMotion> bodies) {
  BodyScene scene;
  scene.id = run.recording.id;
  scene.dt = run.recording.scene.dt;
  scene.subject_ids = run.recording.subject_ids;
  scene.joint_names = DefaultJointNames();
  scene.bodies = std::move(bodies);
  return scene;
}

}  // namespace

const char* GivenBodyFlag() {
  for (const char* flag : {"poses_from", "html_out", "strip_out", "joints_out", "bodies_out"}) {
    if (Given(flag)) return flag;
  }
  return nullptr;
}

Result<std::optional<FormationBodyPlan>> PlanBodies(bool rod_moves, Scene* scene) {
  if (FLAGS_restoration.empty()) {
    const char* flag = GivenBodyFlag();
    if (flag == nullptr) return std::optional<FormationBodyPlan>();
    return Error{std::string("--") + flag +
                 " needs bodies: name the folder of pushid-train-restoration by --restoration"};
  }
  FormationBodyPlan plan;
  Result<std::unique_ptr<Restoration>> restoration = LoadFlaggedRestoration(rod_moves);
  if (!restoration.ok()) return restoration.error();
  plan.restoration = std::move(restoration.value());
  const Result<PostprocessOptions> postprocess = PostprocessOfFlags();
  if (!postprocess.ok()) return postprocess.error();
  plan.postprocess = postprocess.value();
  const Result<std::vector<Pose>> poses = Poses(scene->people.front().body.rod_length);
  if (!poses.ok()) return poses.error();
  plan.first_poses = TakePoses(poses.value(), scene);
  for (const std::string& file :
       {FLAGS_html_out, FLAGS_strip_out, FLAGS_joints_out, FLAGS_bodies_out}) {
    if (file.empty()) continue;
    if (MaybeError error = CheckWritable(file)) return *error;
  }
  return std::optional<FormationBodyPlan>(std::move(plan));
}

MaybeError WriteFormationBodies(const FormationRun& run, const FormationBodyPlan& plan,
                                const std::string& title) {
  const BodyScene scene =
      SceneOf(run, FormationBodies(run, plan.first_poses, *plan.restoration, plan.postprocess));
  Animation animation;
  animation.title = title;
  animation.dt = scene.dt;
  AddPrediction(run.recording, run.prediction, scene.bodies, &animation);
  MaybeError error;
  if (!FLAGS_html_out.empty()) {
    error = WriteFileAtomically(FLAGS_html_out, AnimationHtml(animation));
  }
  if (!error && !FLAGS_strip_out.empty()) {
    error = WriteFileAtomically(FLAGS_strip_out, PoseStripSvg(animation, kPosesOfStrip));
  }
  if (!error && !FLAGS_joints_out.empty()) error = WriteJointsCsv(FLAGS_joints_out, scene);
  if (!error && !FLAGS_bodies_out.empty()) {
    const auto files = WriteBodyBvh(FLAGS_bodies_out, scene);
    if (!files.ok()) error = files.error();
  }
  return error;
}

}  // namespace pushid
