// Groups sampled by diffusion, and their samples finished.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/generators/diffusion_samples.h"

namespace pushid {
namespace {

class DiffusionGeneratorTest : public ::testing::Test {
 protected:
  DiffusionGeneratorTest() {
    layout_.names.resize(kBodyJoints);
    options_.averaged = 2;
    options_.steps = 3;
  }
  DiffusionGenerator Generator(int members = 1, const DiffusionStructure& structure = {}) const {
    std::vector<DiffusionNetwork> networks;
    for (int m = 0; m < members; ++m) {
      networks.push_back(RandomDiffusion(static_cast<uint64_t>(m) + 1, structure));
      networks.back().scales.joints.setConstant(0.02f);
    }
    return DiffusionGenerator(layout_, networks, 1.0 / 60.0, options_, SeededNoise());
  }
  static std::vector<ObservedMotion> Seen(int people, int observed) {
    std::vector<ObservedMotion> group = PushedGroup(people, 40);
    for (ObservedMotion& person : group) {
      person.frames = Trajectories(person.frames.leftCols(observed));
    }
    return group;
  }
  ParticleLayout layout_;
  DiffusionGeneratorOptions options_;
};

TEST_F(DiffusionGeneratorTest, ForecastsRepeatThemselvesInAnyOrder) {
  const DiffusionGenerator generator = Generator(2);
  const auto forecast = generator.Forecast(Seen(4, 5), 20);
  ASSERT_EQ(forecast.size(), 4u);
  EXPECT_EQ(forecast[0].cols(), 20);
  const auto again = generator.Forecast(Seen(4, 5), 20);
  std::vector<ObservedMotion> turned = Seen(4, 5);
  std::reverse(turned.begin(), turned.end());
  const auto reversed = generator.Forecast(turned, 20);
  for (size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(forecast[n], again[n]);
    EXPECT_LT((forecast[n] - reversed[3 - n]).cwiseAbs().maxCoeff(), 1e-5f);
  }
}

// The published generator: everybody in their own frame, pooled at the bottleneck, without fading.
TEST_F(DiffusionGeneratorTest, TheOrderOfPeopleMakesNoDifferenceAsPublished) {
  options_.settle = false;
  for (const SocialPooling pooling : {SocialPooling::kMeanAll, SocialPooling::kHeads}) {
    const DiffusionStructure published = {pooling, SocialJoin::kBottleneck, MotionFrame::kOwn};
    const auto forecast = Generator(1, published).Forecast(Seen(4, 5), 20);
    std::vector<ObservedMotion> turned = Seen(4, 5);
    std::reverse(turned.begin(), turned.end());
    const auto reversed = Generator(1, published).Forecast(turned, 20);
    for (size_t n = 0; n < 4; ++n) {
      EXPECT_LT((forecast[n] - reversed[3 - n]).cwiseAbs().maxCoeff(), 1e-5f);
    }
  }
}

// Where half of the samples are of the group in the mirror, and none has noise of its own.
TEST_F(DiffusionGeneratorTest, InTheMirrorAGroupDoesTheMirrorImage) {
  const GroupChange mirror = {true};
  const auto largest_difference = [&] {
    std::vector<DiffusionNetwork> networks = {RandomDiffusion(1, {})};
    const DiffusionGenerator generator(layout_, networks, 1.0 / 60.0, options_,
                                       [] { return NormalSource([] { return 0.0; }); });
    const auto forecast = generator.Forecast(Seen(3, 5), 20);
    std::vector<ObservedMotion> people(3);
    for (size_t n = 0; n < 3; ++n) people[n].frames = forecast[n];
    people = Changed(people, mirror);
    const auto mirrored = generator.Forecast(Changed(Seen(3, 5), mirror), 20);
    float largest = 0.0f;
    for (size_t n = 0; n < 3; ++n) {
      largest = std::max(largest, (mirrored[n] - people[n].frames).cwiseAbs().maxCoeff());
    }
    return largest;
  };
  EXPECT_LT(largest_difference(), 1e-4f);
  options_.mirrored = false;
  EXPECT_GT(largest_difference(), 1e-3f);
}

// Eq. 6 by hand: two people of three frames each, of which two were seen.
TEST(DiffusionPastTest, SeenFramesTakeTheirPlace) {
  Eigen::MatrixXf estimate(1, 6);
  estimate << 1, 2, 3, 4, 5, 6;
  PutPast({Eigen::RowVector2f(10, 20), Eigen::RowVector2f(30, 40)}, &estimate);
  Eigen::MatrixXf expected(1, 6);
  expected << 10, 20, 3, 30, 40, 6;
  EXPECT_EQ(estimate, expected);
}

TEST_F(DiffusionGeneratorTest, TheSeamFades) {
  const std::vector<ObservedMotion> people = Seen(2, 12);
  const auto jump = [&people](const DiffusionGenerator& generator) {
    return (generator.Forecast(people, 25)[0].col(0) - people[0].frames.col(11)).norm();
  };
  options_.postprocess = {true, 20, false, false};
  const float faded = jump(Generator());
  options_.postprocess.fade_residual = false;
  EXPECT_LT(faded, 0.7f * jump(Generator()));
}

TEST_F(DiffusionGeneratorTest, BonesHold) {
  for (const int observed : {1, 12}) {
    const std::vector<ObservedMotion> people = Seen(2, observed);
    const Trajectories motion = Generator().Forecast(people, 25)[0];
    const Pose first = people[0].frames.col(0).cast<double>().reshaped(3, kBodyJoints);
    for (const int t : {0, 10, 24}) {
      const Pose pose = motion.col(t).cast<double>().reshaped(3, kBodyJoints);
      EXPECT_LT((BoneLengths(pose) - BoneLengths(first)).cwiseAbs().maxCoeff(), 1e-4);
    }
  }
}

TEST_F(DiffusionGeneratorTest, ABlendGoesSomeOfTheWayToThePendulum) {
  options_.postprocess = {false, 0, false, false};
  std::vector<ObservedMotion> people = Seen(2, 1);
  const auto alone = Generator().Forecast(people, 20);
  for (ObservedMotion& person : people) person.pendulum = Eigen::MatrixXf::Constant(3, 21, 2.0f);
  EXPECT_EQ(Generator().Forecast(people, 20)[1], alone[1]);
  options_.blend = 0.25;
  const Trajectories blended = Generator().Forecast(people, 20)[1];
  const Eigen::Vector3f hip = alone[1].col(7).head<3>(), moved = blended.col(7).head<3>();
  EXPECT_LT((moved - hip - 0.25f * (Eigen::Vector3f::Constant(2.0f) - hip)).norm(), 1e-5f);
  const Eigen::Vector3f head = alone[1].col(7).segment<3>(3 * kBodyHead);
  EXPECT_LT((blended.col(7).segment<3>(3 * kBodyHead) - moved - (head - hip)).norm(), 1e-5f);
}

// Past what was learnt people come to rest, and nothing before it changes.
TEST_F(DiffusionGeneratorTest, LongForecastsSettle) {
  options_.postprocess = {false, 0, false, false};
  options_.averaged = 1;
  options_.learnt_frames = 60;
  options_.settling = 0.25;
  const std::vector<ObservedMotion> people = Seen(2, 1);
  const Trajectories whole = Generator().Forecast(people, 200)[1];
  ASSERT_EQ(whole.cols(), 200);
  options_.learnt_frames = 1000;
  const Trajectories restless = Generator().Forecast(people, 200)[1];
  options_.learnt_frames = 60;
  options_.settle = false;
  EXPECT_EQ(Generator().Forecast(people, 200)[1], restless);
  EXPECT_EQ(Trajectories(whole.leftCols(58)), Trajectories(restless.leftCols(58)));
  const auto step = [](const Trajectories& motion, int t) {
    return (motion.col(t) - motion.col(t - 1)).norm();
  };
  // Column 59 is frame 60; a quarter of a second later a step has lost 1 - 1/e of its size.
  EXPECT_NEAR(step(whole, 59), step(restless, 59), 1e-5f);
  EXPECT_NEAR(step(whole, 74), std::exp(-1.0) * step(restless, 74), 1e-4f);
  EXPECT_LT(step(whole, 199), 1e-3f * step(restless, 199) + 1e-6f);
}

TEST_F(DiffusionGeneratorTest, NobodyHasNoFuture) {
  EXPECT_TRUE(Generator().Forecast({}, 10).empty());
}

}  // namespace
}  // namespace pushid
