// The numbers of siMLPe by hand, and its way through a motion.
#include "models/peers/simlpe.h"

#include <gtest/gtest.h>

#include "tests/models/body_samples.h"

namespace pushid {
namespace {

BodyMotion Walking(int frames) {
  BodyMotion motion;
  for (int t = 0; t < frames; ++t) motion.push_back(Placed(StandingPose(), 0.4, {0.01 * t, 0, 0}));
  return motion;
}

TEST(SimlpeTest, AStandingBodyHasOnlyTheMeanCoefficient) {
  const BodyMotion motion(12, StandingPose());
  const Eigen::VectorXf input = SimlpeInput(motion, 11);
  ASSERT_EQ(input.size(), kSimlpeInputs);
  for (int joint = 0; joint < kBodyJoints; ++joint) {
    for (int i = 0; i < 3; ++i) {
      const int column = kSimlpeGiven * (3 * joint + i);
      const double place = StandingPose()(i, joint) - StandingPose()(i, 0);
      EXPECT_NEAR(input[column], std::sqrt(12.0) * place, 1e-5);
      EXPECT_LT(input.segment<11>(column + 1).norm(), 1e-5);
    }
  }
}

TEST(SimlpeTest, TargetsAreWaysFromTheLastGivenFrameInItsHeading) {
  const BodyMotion motion = Walking(20);
  const Eigen::VectorXf target = SimlpeTarget(motion, 11);
  for (int t = 0; t < kSimlpeFrames; ++t) {
    const double way = 0.01 * (t + 1);
    EXPECT_NEAR(target[66 * t], way * std::cos(0.4), 1e-6);
    EXPECT_NEAR(target[66 * t + 1], -way * std::sin(0.4), 1e-6);
  }
  // Neither depends on where the person stands and which way the person faces.
  BodyMotion turned;
  for (const Pose& pose : motion) turned.push_back(Placed(pose, 1.3, {5, 6, 0}));
  EXPECT_LT((SimlpeTarget(turned, 11) - target).norm(), 1e-5);
  EXPECT_LT((SimlpeInput(turned, 11) - SimlpeInput(motion, 11)).norm(), 1e-4);
}

TEST(SimlpeTest, ContinuesItsOwnOutput) {
  // A network that always says: a centimetre a frame along x of the heading.
  SimlpeWeights weights;
  weights.inputs = UnitScaling(kSimlpeInputs);
  DenseLayer layer{Eigen::MatrixXf::Zero(kSimlpeOutputs, kSimlpeInputs),
                   Eigen::VectorXf::Zero(kSimlpeOutputs)};
  for (int t = 0; t < kSimlpeFrames; ++t) {
    for (int j = 0; j < kBodyJoints; ++j) {
      layer.bias[66 * t + 3 * j] = 0.01f * static_cast<float>(t + 1);
    }
  }
  weights.network.layers = {layer};
  const BodyMotion given(12, Placed(StandingPose(), 0.4, {0, 0, 0}));
  const BodyMotion motion = SimlpePeer(weights).Continue({given}, 27)[0];
  ASSERT_EQ(motion.size(), 27u);
  EXPECT_EQ(motion[11], given[11]);
  for (int t = 12; t < 27; ++t) {
    const Eigen::Vector3d way = motion[t].col(5) - given[11].col(5);
    EXPECT_NEAR(way.x(), 0.01 * (t - 11) * std::cos(0.4), 1e-6) << t;
    EXPECT_NEAR(way.y(), 0.01 * (t - 11) * std::sin(0.4), 1e-6) << t;
  }
}

}  // namespace
}  // namespace pushid
