// Bodies of formations by a generator of diffusion, with networks of random weights.
#include <gtest/gtest.h>

#include "ident/formations/formation_run.h"
#include "ident/generators/push_particles.h"
#include "tests/ident/formation_samples.h"
#include "tests/models/generators/diffusion_samples.h"
#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr int kBodyFrames = 40;

LoadedGenerator RandomGenerator(double blend) {
  DiffusionGeneratorOptions options;
  options.averaged = 1;
  options.steps = 2;
  options.blend = blend;
  options.postprocess.lock_feet = false;
  LoadedGenerator loaded;
  loaded.kind = GeneratorKind::kDiffusion;
  loaded.settings.data = GeneratorData::kPushes;
  loaded.settings.observed = 20;
  loaded.settings.rate = 60.0;
  loaded.settings.push_kinds = {PushKind::kNet};
  loaded.generator = std::make_unique<DiffusionGenerator>(
      PushLayout(std::vector<std::string>(kBodyJoints, "joint")),
      std::vector<DiffusionNetwork>{RandomDiffusion(1, {})}, 1.0 / 60.0, options, SeededNoise());
  return loaded;
}

class GeneratedBodiesTest : public ::testing::Test {
 protected:
  GeneratedBodiesTest() {
    scene_ = SampleFormation(FormationShape::kDiamond, 5, {0});
    first_poses_ = TakePoses({SyntheticPose(0.9), StandingPose()}, &scene_);
    run_ = RunFormation(ContactModel(), scene_, kBodyFrames);
  }
  std::vector<BodyMotion> Bodies(LoadedGenerator loaded) const {
    EXPECT_FALSE(PrepareForFormation(scene_, "generator", &loaded));
    return Unwrapped(GeneratedBodies(run_, first_poses_, loaded));
  }
  // Of the hips, from those of the pendulums.
  double FarthestHip(const std::vector<BodyMotion>& bodies) const {
    double farthest = 0.0;
    for (int n = 0; n < run_.num_people(); ++n) {
      for (int t = 0; t < kBodyFrames; ++t) {
        const Eigen::Vector3d way = bodies[n][t].col(kBodyHip) - run_.prediction.hip[n][t];
        farthest = std::max(farthest, way.norm());
      }
    }
    return farthest;
  }
  Scene scene_;
  std::vector<Pose> first_poses_;
  FormationRun run_;
};

TEST_F(GeneratedBodiesTest, BeginAtTheFirstPosesAndKeepTheirBones) {
  const std::vector<BodyMotion> bodies = Bodies(RandomGenerator(0.0));
  ASSERT_EQ(bodies.size(), 5u);
  double moved = 0.0;
  for (int n = 0; n < 5; ++n) {
    ASSERT_EQ(bodies[n].size(), static_cast<size_t>(kBodyFrames));
    EXPECT_LT((bodies[n][0] - first_poses_[n]).norm(), 1e-5);
    for (int j = 1; j < kBodyJoints; ++j) {
      const auto bone = [&](const Pose& pose) {
        return (pose.col(j) - pose.col(kBodyParents[j])).norm();
      };
      EXPECT_NEAR(bone(bodies[n][kBodyFrames - 1]), bone(first_poses_[n]), 1e-5);
    }
    moved = std::max(moved, (bodies[n][kBodyFrames - 1] - first_poses_[n]).norm());
  }
  EXPECT_GT(moved, 0.01) << "random weights move somebody";
}

// All the way to physics: the hips are those of the pendulums, of everybody where they stand.
TEST_F(GeneratedBodiesTest, BlendWithTheRunsOwnPhysics) {
  EXPECT_LT(FarthestHip(Bodies(RandomGenerator(1.0))), 1e-5);
  EXPECT_GT(FarthestHip(Bodies(RandomGenerator(0.0))), 1e-3);
}

// Nothing of what follows the first poses is seen: another run, without physics in it, is the same.
TEST_F(GeneratedBodiesTest, SeeTheFirstPosesAndThePushAlone) {
  const std::vector<BodyMotion> before = Bodies(RandomGenerator(0.0));
  IdentifiedModel slippery = ContactModel();
  slippery.parameters[kMu] *= 0.5;
  run_ = RunFormation(slippery, scene_, kBodyFrames);
  const std::vector<BodyMotion> after = Bodies(RandomGenerator(0.0));
  for (int n = 0; n < 5; ++n) EXPECT_EQ(before[n].back(), after[n].back());
  scene_.pushes.clear();
  AddHipPush(0, {20.0, 0.0, 0.2}, &scene_);
  run_ = RunFormation(ContactModel(), scene_, kBodyFrames);
  EXPECT_GT((Bodies(RandomGenerator(0.0))[0].back() - before[0].back()).norm(), 1e-4);
}

TEST_F(GeneratedBodiesTest, AGeneratorThatDoesNotFitIsRefused) {
  LoadedGenerator loaded = RandomGenerator(0.0);
  loaded.settings.rate = 50.0;
  const std::string rate = ProblemOf(PrepareForFormation(scene_, "generator", &loaded));
  EXPECT_TRUE(Contains(rate, "--generator names a generator that was trained at 50"));
  EXPECT_TRUE(Contains(rate, "--fps=50"));
  loaded.settings.rate = 60.0;
  loaded.kind = GeneratorKind::kParticles;
  EXPECT_TRUE(
      Contains(ProblemOf(PrepareForFormation(scene_, "generator", &loaded)), "--kind=diffusion"));
}

TEST_F(GeneratedBodiesTest, PushesOfAnotherKindAreNamed) {
  GeneratorSettings settings = RandomGenerator(0.0).settings;
  const std::string other = OtherPushKinds(settings, scene_);
  EXPECT_TRUE(Contains(other, "of kind net and is applied to pushes of kind external"));
  settings.push_kinds = {PushKind::kNet, PushKind::kExternal};
  EXPECT_EQ(OtherPushKinds(settings, scene_), "");
  settings.push_kinds.clear();
  EXPECT_EQ(OtherPushKinds(settings, scene_), "") << "not known";
}

}  // namespace
}  // namespace pushid
