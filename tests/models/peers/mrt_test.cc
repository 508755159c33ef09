// The numbers of MRT by hand, what it must not depend on, and its way through a motion.
#include <gtest/gtest.h>

#include "models/peers/mrt_network.h"
#include "tests/models/mrt_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(MrtFeaturesTest, AStandingGroupHasNoMotionAndPlaces) {
  const BodyMotion here(20, Placed(StandingPose(), 0.4, {1.0, 2.0, 0.0}));
  // A metre in front of the first, facing them.
  const BodyMotion there(20, Placed(here[0], 0.0, {std::cos(0.4), std::sin(0.4), 0.0}));
  const MrtView view = MrtViewOf({here, there}, 19, 0);
  EXPECT_EQ(view.tokens.cols(), 2 * kMrtTokens);
  EXPECT_EQ(view.tokens.norm(), 0.0f);
  const float e = std::exp(-1.0f);
  EXPECT_LT((view.places.col(0) - Eigen::Matrix<float, 5, 1>(0, 0, 1, 0, 1)).norm(), 1e-6);
  EXPECT_LT((view.places.col(1) - Eigen::Matrix<float, 5, 1>(1, 0, e, 0, 1)).norm(), 1e-6);
  EXPECT_NEAR(view.query[2], 1.0f, 1e-6) << "the hip's height";
  EXPECT_LT(view.query.tail(kMrtPoseRows).norm(), 1e-6) << "no displacement";
}

TEST(MrtFeaturesTest, ASteadyWalkHasOnlyTheMeanCoefficient) {
  BodyMotion walk;
  for (int t = 0; t < 40; ++t) {
    walk.push_back(
        Placed(StandingPose(), 0.4, {0.01 * t * std::cos(0.4), 0.01 * t * std::sin(0.4), 0.0}));
  }
  const MrtView view = MrtViewOf({walk}, 19, 0);
  EXPECT_NEAR(view.tokens(0, 0), 0.01 * std::sqrt(19.0), 1e-6) << "ahead, in its own heading";
  EXPECT_NEAR(view.tokens(1, 0), 0.0, 1e-6);
  EXPECT_LT(view.tokens.rightCols(kMrtTokens - 1).norm(), 1e-6);
  const Eigen::MatrixXf ways = MrtWays(walk, 19);
  EXPECT_NEAR(ways(0, 0), 0.01, 1e-6);
  EXPECT_NEAR(ways(0, 19), 0.2, 1e-6);
  EXPECT_NEAR(MrtCoefficientsOf(ways)(0, 0), 0.01 * std::sqrt(20.0), 1e-6);
}

TEST(MrtFeaturesTest, WaysComeBackFromTheirCoefficients) {
  Random random(3);
  const Eigen::MatrixXf ways = RandomMatrix(kMrtPoseRows, kMrtFrames, 0.3, &random);
  EXPECT_LT((MrtWaysOf(MrtCoefficientsOf(ways)) - ways).norm(), 1e-4);
}

// Nothing may depend on where a group stands and which way it faces.
TEST(MrtTest, PlaceAndHeadingChangeNothing) {
  const MrtPeer peer(RandomMrt());
  const std::vector<BodyMotion> group = WalkingGroup(3, 20);
  const Eigen::Vector3d move(5.0, -3.0, 0.0);
  std::vector<BodyMotion> turned = group;
  for (BodyMotion& motion : turned) {
    for (Pose& pose : motion) pose = Placed(pose, 2.1, move);
  }
  const std::vector<BodyMotion> said = peer.Continue(group, 63);
  const std::vector<BodyMotion> said_turned = peer.Continue(turned, 63);
  for (int n = 0; n < 3; ++n) {
    EXPECT_GT((said[n][62] - said[n][19]).norm(), 0.01) << "or it would say nothing";
    EXPECT_LT((Placed(said[n][62], 2.1, move) - said_turned[n][62]).norm(), 1e-4) << n;
  }
}

TEST(MrtTest, TheOrderOfPeopleChangesNothing) {
  const MrtPeer peer(RandomMrt());
  const std::vector<BodyMotion> group = WalkingGroup(3, 20);
  const std::vector<BodyMotion> said = peer.Continue(group, 63);
  const std::vector<BodyMotion> other = peer.Continue({group[2], group[0], group[1]}, 63);
  for (int n = 0; n < 3; ++n) {
    EXPECT_LT((said[n][62] - other[(n + 1) % 3][62]).norm(), 1e-4) << n;
  }
}

TEST(MrtTest, PeopleSeeEachOther) {
  const MrtPeer peer(RandomMrt());
  std::vector<BodyMotion> group = WalkingGroup(2, 20);
  const Pose alone = peer.Continue({group[0]}, 40)[0][39];
  const Pose beside = peer.Continue(group, 40)[0][39];
  for (Pose& pose : group[1]) pose = Placed(pose, 0.0, {0.5, 0.0, 0.0});
  const Pose farther = peer.Continue(group, 40)[0][39];
  EXPECT_GT((alone - beside).norm(), 1e-3);
  EXPECT_GT((beside - farther).norm(), 1e-3);
}

// The given frames stay, later ones are not read, and parts of 20 frames join.
TEST(MrtTest, GoesOnFromItsOwnOutput) {
  const MrtPeer peer(RandomMrt());
  std::vector<BodyMotion> group = WalkingGroup(2, 70);
  const std::vector<BodyMotion> said = peer.Continue(group, 65);
  ASSERT_EQ(said[0].size(), 65u);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(said[1][t], group[1][t]);
  for (BodyMotion& motion : group) {
    for (size_t t = 20; t < motion.size(); ++t) motion[t].setZero();
  }
  EXPECT_EQ(peer.Continue(group, 65)[1][64], said[1][64]);
  EXPECT_EQ(peer.Continue(group, 30)[1][29], said[1][29]);
  const std::vector<BodyMotion> seen = {{said[0].begin() + 20, said[0].begin() + 40},
                                        {said[1].begin() + 20, said[1].begin() + 40}};
  EXPECT_LT((peer.Continue(seen, 40)[1][39] - said[1][59]).norm(), 1e-4);
}

TEST(MrtTest, TensorsComeBackToTheLastBit) {
  const MrtWeights weights = RandomMrt();
  TensorList tensors;
  AddTensors(weights, &tensors);
  TensorReader reader(tensors);
  const MrtWeights again = TakeMrt(MrtSize::kSmall, &reader);
  EXPECT_EQ(reader.problem(), "");
  const std::vector<BodyMotion> group = WalkingGroup(2, 20);
  EXPECT_EQ(MrtPeer(weights).Continue(group, 40)[0][39], MrtPeer(again).Continue(group, 40)[0][39]);
  TensorReader other(tensors);
  TakeMrt(MrtSize::kPublished, &other);
  EXPECT_TRUE(Contains(other.problem(), "not 128 x 66"));
}

}  // namespace
}  // namespace pushid
