// ident: bodies of formations.
#include "ident/formations/formation_bodies.h"

#include <algorithm>

#include "datasets/files/number_text.h"
#include "datasets/formats/bvh_kinematics.h"
#include "datasets/synthetic/synthetic_skeleton.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/generators/push_particles.h"
#include "ident/parameters/option_names.h"
#include "ident/prediction/predicted_steps.h"
#include "models/skeleton_mapping.h"

namespace pushid {

Pose SyntheticPose(double rod_length) {
  const SyntheticSkeleton skeleton(rod_length);
  const Eigen::Vector3d cart(0.0, 0.0, skeleton.cart_height());
  SkeletonPose upright;
  upright.hip = cart + Eigen::Vector3d(0.0, 0.0, rod_length);
  upright.left_ankle = cart + skeleton.HalfStance();
  upright.right_ankle = cart - skeleton.HalfStance();
  std::vector<double> row;
  skeleton.AppendFrame(upright, LengthUnit::kMetre, &row);
  std::vector<int> joints(kBodyJoints);
  for (int j = 0; j < kBodyJoints; ++j) joints[j] = j;
  BvhKinematics kinematics(skeleton.Bvh(LengthUnit::kMetre), LengthUnit::kMetre, joints);
  std::vector<Eigen::Vector3d> positions(kBodyJoints);
  kinematics.Positions(row.data(), positions.data());
  Pose pose;
  for (int j = 0; j < kBodyJoints; ++j) pose.col(j) = positions[j];
  return pose;
}

std::vector<Pose> FirstPoses(const std::vector<BodyRecording>& recordings) {
  std::vector<Pose> poses;
  for (const BodyRecording& recording : recordings) {
    for (const BodyMotion& body : recording.bodies) poses.push_back(body.front());
  }
  return poses;
}

std::vector<Pose> TakePoses(const std::vector<Pose>& poses, Scene* scene) {
  std::vector<Pose> placed;
  for (int n = 0; n < scene->num_people(); ++n) {
    ScenePerson& person = scene->people[n];
    Pose pose = poses[n % poses.size()];
    pose = (TurnAboutZ(-Heading(pose)) * pose).eval();
    const Eigen::Vector3d cart = 0.5 * (pose.col(kLeftAnkle) + pose.col(kRightAnkle));
    pose.colwise() +=
        Eigen::Vector3d(person.start.q[0] - cart.x(), person.start.q[1] - cart.y(), 0.0);
    const MappedPose mapped = MapSkeleton(pose.col(0), pose.col(kLeftAnkle), pose.col(kRightAnkle),
                                          SkeletonMapping::kExact);
    person.body.rod_length = mapped.rod_length;
    person.body.cart_height = mapped.cart_height;
    person.start.q = mapped.q;
    placed.push_back(pose);
  }
  return placed;
}

std::vector<BodyMotion> FormationBodies(const FormationRun& run,
                                        const std::vector<Pose>& first_poses,
                                        const Restoration& restoration,
                                        const PostprocessOptions& options) {
  const Scene& scene = run.recording.scene;
  std::vector<RestorationInput> people = PeopleOf(scene, first_poses);
  for (int n = 0; n < scene.num_people(); ++n) {
    for (int t = 0; t < run.num_frames(); ++t) {
      people[n].q.push_back(run.prediction.path.At(t, n).q);
    }
    people[n].stands = StandingFrames(run.prediction, n);
  }
  return RestoreBodies(restoration, options, people);
}

MaybeError PrepareForFormation(const Scene& scene, const std::string& flag,
                               LoadedGenerator* loaded) {
  GeneratorSettings& settings = loaded->settings;
  if (loaded->kind != GeneratorKind::kDiffusion) {
    return Error{"--" + flag + " names a generator of " + NameOf(loaded->kind) +
                 ", whose people do not interact: only the pushed would move; give one that "
                 "pushid-train-generator --kind=" +
                 NameOf(GeneratorKind::kDiffusion) + " wrote"};
  }
  if (!AtRateOf(settings, scene.dt)) {
    return Error{"--" + flag + " names a generator that was trained at " +
                 Rounded(settings.rate, 3) + " frames per second, and the formation has " +
                 Rounded(1.0 / scene.dt, 3) + ": give --fps=" + Rounded(settings.rate, 3)};
  }
  settings.observed = 1;
  return std::nullopt;
}

Result<std::vector<BodyMotion>> GeneratedBodies(const FormationRun& run,
                                                const std::vector<Pose>& first_poses,
                                                const LoadedGenerator& loaded) {
  BodyRecording held;
  held.pendulum = run.recording;
  for (const Pose& pose : first_poses) {
    held.bodies.emplace_back(run.num_frames(), pose);
    held.pendulum.hip.emplace_back(run.num_frames(), pose.col(kBodyHip));
  }
  const GroupHips hips = PendulumHips(held, run.prediction.path);
  return GenerateBodies(loaded.settings, *loaded.generator, held, hips, run.num_frames());
}

}  // namespace pushid
