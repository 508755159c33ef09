// The diffusion network without its training: schedule, features and back, who sees whom, what
// later frames may change.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/generators/diffusion_samples.h"

namespace pushid {
namespace {

TEST(DiffusionScheduleTest, FromAllSignalToNone) {
  EXPECT_EQ(SignalShare(0.0), 1.0);
  EXPECT_LT(SignalShare(kDiffusionTime), 1e-12);
  // By hand, t = 500: cos^2(0.508 / 1.008 pi/2) / cos^2(0.008 / 1.008 pi/2).
  EXPECT_NEAR(SignalShare(500.0), 0.493844, 1e-6);
  for (int t = 1; t <= kDiffusionTime; ++t) EXPECT_LT(SignalShare(t), SignalShare(t - 1));
}

// Eq. 5 at t = 500: sqrt(0.493844) 2 + sqrt(0.506156) 3.
TEST(DiffusionScheduleTest, Equation5ByHand) {
  const auto one = [](float value) { return Eigen::MatrixXf::Constant(1, 1, value); };
  EXPECT_NEAR(NoisedAgain(one(2.0f), one(3.0f), 500.0)(0, 0), 3.539820f, 1e-5f);
}

TEST(DiffusionFeaturesTest, MotionsComeBack) {
  const std::vector<ObservedMotion> group = PushedGroup(3, 40);
  const JointScales scales = MotionScalesOf({group}, MotionFrame::kGroup).joints;
  EXPECT_GE(scales.minCoeff(), 0.02f);
  EXPECT_GE(scales[kBodyHip], 0.05f);
  for (const ObservedMotion& person : group) {
    const Eigen::MatrixXf rows = MotionRows(person, scales);
    EXPECT_EQ(rows.col(0).norm(), 0.0f) << "everything counts from frame 0";
    const Trajectories back = FromMotionRows(rows, person, scales);
    EXPECT_LT((back - person.frames).cwiseAbs().maxCoeff(), 1e-5f);
  }
}

// A group and the same group turned by 0.7 rad: joints in people's own frames are the same, and
// heading differs by what it was turned. Rows have zero mean and unit variance over the group.
TEST(DiffusionFeaturesTest, OwnFramesKnowNoTurn) {
  const std::vector<ObservedMotion> group = PushedGroup(3, 40);
  const std::vector<ObservedMotion> turned = Changed(group, {false, 0.7, 1.0});
  MotionScales plain = MotionScalesOf({group}, MotionFrame::kOwn);
  const MotionScales scales = plain;
  plain.mean.setZero();
  plain.spread.setOnes();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kOwnFrameRows), squares = sum;
  for (size_t n = 0; n < group.size(); ++n) {
    const Eigen::MatrixXf a = MotionRows(group[n], plain);
    const Eigen::MatrixXf b = MotionRows(turned[n], plain);
    EXPECT_LT((a - b).middleRows(3, kMotionRows - 3).cwiseAbs().maxCoeff(), 1e-5f);
    const double from = std::atan2(a(67, 9), a(66, 9)), to = std::atan2(b(67, 9), b(66, 9));
    EXPECT_NEAR(to - from, 0.7, 1e-5);
    const Eigen::MatrixXf rows = MotionRows(group[n], scales);
    EXPECT_LT((FromMotionRows(rows, group[n], scales) - group[n].frames).cwiseAbs().maxCoeff(),
              1e-5f);
    sum += rows.cast<double>().array().rowwise().sum();
    squares += rows.cast<double>().array().square().rowwise().sum();
  }
  EXPECT_LT((sum / 120.0).abs().maxCoeff(), 1e-3);
  EXPECT_NEAR(squares[0] / 120.0, 1.0, 1e-3) << "the hip goes forwards";
}

TEST(DiffusionFeaturesTest, EverybodyIsToldOfThePushAndWhereItComesFrom) {
  const std::vector<ObservedMotion> group = PushedGroup(3, 20);
  const GroupFeatures features = FeaturesOf(group, JointScales::Constant(0.1f), 2, 20, 1.0 / 60.0);
  for (int n = 0; n < 3; ++n) {
    const auto given = features.given.middleCols(20 * n, 20);
    EXPECT_EQ(given(kMotionRows, 1), 1.0f);
    EXPECT_EQ(given(kMotionRows, 2), 0.0f);
    EXPECT_EQ(given.topRightCorner(kMotionRows, 18).norm(), 0.0f) << "what was not seen";
    EXPECT_NEAR(given(kMotionRows + 1, 3), 0.4f, 1e-6f);  // 4 N/kg over 10
    const auto statics = features.statics.col(n);
    const int place = kMotionRows - 3;
    EXPECT_NEAR(statics[place], 0.6f * static_cast<float>(n), 1e-6f);
    EXPECT_EQ(statics[place + 4], n == 0 ? 1.0f : 0.0f);
    EXPECT_NEAR(statics[place + 5], 0.4f, 1e-6f);  // 4 N/kg for 6/60 s
    EXPECT_NEAR(statics[place + 9], 0.4f, 1e-6f);  // 6 of 15 frames
  }
}

// Twice in the mirror, there and back again, and a push that turns along.
TEST(DiffusionFeaturesTest, ChangesAreUndone) {
  std::vector<ObservedMotion> group = PushedGroup(2, 10);
  group[0].controls.row(2).setConstant(1.0f);  // leaning forwards
  const auto same = [&](const std::vector<ObservedMotion>& other, float tolerance) {
    for (size_t n = 0; n < group.size(); ++n) {
      EXPECT_LT((other[n].frames - group[n].frames).norm(), tolerance);
      EXPECT_LT((other[n].controls - group[n].controls).norm(), tolerance);
      EXPECT_LT((other[n].place - group[n].place).norm(), tolerance);
    }
  };
  same(Changed(Changed(group, {true, 0.0, 1.0}), {true, 0.0, 1.0}), 1e-6f);
  same(Changed(Changed(group, {false, 0.3, 1.25}), {false, -0.3, 0.8}), 1e-4f);
  // A quarter to the left: pushed to +y, and leaning to +y is a phi below zero.
  const auto turned = Changed(group, {false, M_PI_2, 1.0});
  EXPECT_NEAR(turned[0].controls(1, 0), 4.0f, 1e-5f);
  EXPECT_NEAR(turned[0].controls(3, 0), -1.0f, 1e-5f);
  // In the mirror the left wrist is the right one.
  const auto mirrored = Changed(group, {true, 0.0, 1.0});
  EXPECT_EQ(mirrored[0].frames(3 * kLeftWrist + 1, 5), -group[0].frames(3 * kRightWrist + 1, 5));
}

TEST(PoolingWeightsTest, NearPeopleCountAndFarOnesFade) {
  Eigen::Matrix2Xf places(2, 3);
  places << 0.0f, 0.5f, 9.0f, 0.0f, 0.0f, 0.0f;
  const auto local = PoolingWeights(SocialPooling::kLocal, places);
  ASSERT_EQ(local.size(), 2u);
  EXPECT_GT(local[0](0, 1), 0.8f) << "ahead of the first stands the second";
  EXPECT_LT(local[1](0, 1), 0.1f);
  EXPECT_GT(local[1](1, 0), 0.8f);
  EXPECT_LT(local[0].row(2).sum() + local[1].row(2).sum(), 1e-6f) << "9 m off one is alone";
  for (const Eigen::MatrixXf& view : local) EXPECT_EQ(view.diagonal().norm(), 0.0f);
  EXPECT_TRUE(PoolingWeights(SocialPooling::kNone, places).empty());
  const auto all = PoolingWeights(SocialPooling::kMeanAll, places);
  EXPECT_EQ(all[0], Eigen::MatrixXf::Constant(3, 3, 1.0f / 3.0f)) << "oneself included";
}

Eigen::MatrixXf Noise(Eigen::Index columns) {
  Random random(5);
  return RandomMatrix(kMotionRows, static_cast<int>(columns), 1.0, &random);
}

class DenoiserTest : public ::testing::TestWithParam<SocialPooling> {
 protected:
  DiffusionNetwork Network() const { return RandomDiffusion(3, {GetParam()}); }
  static GroupFeatures Features(const std::vector<ObservedMotion>& group, int frames) {
    return FeaturesOf(group, JointScales::Constant(0.1f), 1, frames, 1.0 / 60.0);
  }
};

// A motion may go on past the frames of the training, and be cut anywhere.
TEST_P(DenoiserTest, LaterFramesChangeNoEarlierOnes) {
  const DiffusionNetwork network = Network();
  const std::vector<ObservedMotion> group = PushedGroup(1, 90);
  const Eigen::MatrixXf noise = Noise(90);
  const Eigen::MatrixXf whole = GroupDenoiser(network, Features(group, 90)).Estimate(noise, 300);
  for (const int frames : {16, 33, 70}) {
    // The statics hold the whole push, which is over by then.
    const Eigen::MatrixXf part =
        GroupDenoiser(network, Features(group, frames)).Estimate(noise.leftCols(frames), 300);
    EXPECT_LT((part - whole.leftCols(frames)).cwiseAbs().maxCoeff(), 1e-4f) << frames;
  }
}

TEST_P(DenoiserTest, TheOrderOfPeopleMakesNoDifference) {
  const DiffusionNetwork network = Network();
  for (const int people : {1, 2, 5, 13}) {
    const std::vector<ObservedMotion> group = PushedGroup(people, 40);
    std::vector<ObservedMotion> other(group.rbegin(), group.rend());
    const Eigen::MatrixXf noise = Noise(40 * people);
    Eigen::MatrixXf turned(noise.rows(), noise.cols());
    for (int n = 0; n < people; ++n) {
      turned.middleCols(40 * n, 40) = noise.middleCols(40 * (people - 1 - n), 40);
    }
    const Eigen::MatrixXf a = GroupDenoiser(network, Features(group, 40)).Estimate(noise, 700);
    const Eigen::MatrixXf b = GroupDenoiser(network, Features(other, 40)).Estimate(turned, 700);
    for (int n = 0; n < people; ++n) {
      EXPECT_LT((a.middleCols(40 * n, 40) - b.middleCols(40 * (people - 1 - n), 40))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-4f)
          << people << " " << n;
    }
  }
}

TEST_P(DenoiserTest, PeopleSeeEachOtherAsTheyShould) {
  const DiffusionNetwork network = Network();
  std::vector<ObservedMotion> group = PushedGroup(3, 32);
  group[2].place.x() = 30.0f;
  Eigen::MatrixXf noise = Noise(3 * 32);
  const Eigen::MatrixXf before = GroupDenoiser(network, Features(group, 32)).Estimate(noise, 700);
  noise.middleCols(32, 32).array() += 1.0f;  // of the second
  const Eigen::MatrixXf after = GroupDenoiser(network, Features(group, 32)).Estimate(noise, 700);
  const auto changed = [&](int n) {
    return (after - before).middleCols(32 * n, 32).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(changed(1), 1e-2f);
  if (GetParam() == SocialPooling::kNone) {
    EXPECT_EQ(changed(0), 0.0f);
  } else {
    EXPECT_GT(changed(0), 1e-3f);
  }
  const bool sees_far = GetParam() != SocialPooling::kLocal && GetParam() != SocialPooling::kNone;
  EXPECT_EQ(changed(2) > 1e-5f, sees_far);
}

INSTANTIATE_TEST_SUITE_P(Poolings, DenoiserTest,
                         ::testing::Values(SocialPooling::kLocal, SocialPooling::kNone,
                                           SocialPooling::kMeanAll, SocialPooling::kHeads));

}  // namespace
}  // namespace pushid
