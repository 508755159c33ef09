// The numbers that the networks see, by hand and there and back.
#include <gtest/gtest.h>

#include "models/restoration/cvae_features.h"
#include "models/restoration/window_features.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

BodyMotion RandomMotion(const RestorationInput& person, uint64_t seed) {
  Random random(seed);
  BodyMotion motion;
  for (size_t t = 0; t < person.q.size(); ++t) {
    Pose pose = person.first_pose.colwise() +
                (TipAt(person, static_cast<int>(t)) - person.first_pose.col(0));
    for (int i = 3; t > 0 && i < pose.size(); ++i) pose.data()[i] += 0.02 * random.Normal();
    motion.push_back(pose);
  }
  return motion;
}

TEST(WindowFeaturesTest, NumbersByHand) {
  RestorationInput person = WithPendulum(StandingPose(), 72.0);
  const Vector4<double> start = person.q[0];
  person.q.clear();
  for (int t = 0; t < 61; ++t) {
    person.q.push_back(start + Vector4<double>(0.01 * t, -0.002 * t, 0.001 * t, 0.0005 * t));
  }
  person.push_start = 0.1;
  const Eigen::MatrixXf inputs = WindowInputs(person);
  ASSERT_EQ(inputs.rows(), kWindowInputs);
  ASSERT_EQ(inputs.cols(), 61);
  const auto at = inputs.col(30);
  EXPECT_NEAR(at[0], 0.30, 1e-6);  // lag 0: against frame 0
  EXPECT_NEAR(at[1], -0.06, 1e-6);
  EXPECT_NEAR(at[2], 0.030, 1e-6);
  EXPECT_NEAR(at[3], 0.015, 1e-6);
  EXPECT_NEAR(at[4], -0.02, 1e-6);     // lag -2: against now
  EXPECT_NEAR(at[6], 0.028, 1e-6);     // theta against frame 0
  EXPECT_NEAR(at[4 * 8], 0.02, 1e-6);  // lag +2
  EXPECT_NEAR(at[4 * 14], 0.24, 1e-6);
  EXPECT_NEAR(at[60], 0.6, 1e-4);  // rate of x
  EXPECT_NEAR(at[61], -0.12, 1e-4);
  EXPECT_NEAR(at[80], 0.4, 1e-6);  // time since the push
  EXPECT_NEAR(at[81], 72.0, 1e-6);
  EXPECT_NEAR(at[82], person.body.rod_length, 1e-6);
  EXPECT_NEAR(at[83], LegLength(person.first_pose), 1e-6);
  EXPECT_NEAR(at[84], start[2], 1e-6);
  const Eigen::Vector3d knee = person.first_pose.col(kRightKnee) - person.first_pose.col(0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(at[86 + i], knee[i], 1e-6);
  // Beyond the ends the ends are seen.
  EXPECT_NEAR(inputs(4 * 14, 60), 0.0, 1e-6);
  EXPECT_NEAR(inputs(4, 0), 0.0, 1e-6);
}

TEST(WindowFeaturesTest, TargetsComeBackAsTheMotion) {
  const RestorationInput person =
      MovingPerson(Placed(StandingPose(), 1.1, {0.3, 0.7, 0.0}), 80, 20);
  const BodyMotion motion = RandomMotion(person, 1);
  const BodyMotion back = MotionFromOutputs(person, WindowTargets(person, motion));
  for (int t = 0; t < 20; ++t) EXPECT_LT((back[t] - motion[t]).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(WindowTargets(person, motion).col(0).norm(), 1e-6) << "nothing has moved at frame 0";
}

TEST(WindowFeaturesTest, TheMirrorMirrorsInputsAndTargets) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20), other = Mirrored(person);
  const Eigen::MatrixXf a = WindowInputs(person), b = WindowInputs(other);
  EXPECT_NEAR(a(0, 12), b(0, 12), 1e-6);
  EXPECT_NEAR(a(1, 12), -b(1, 12), 1e-6);
  EXPECT_NEAR(a(2, 12), b(2, 12), 1e-6);
  EXPECT_NEAR(a(3, 12), -b(3, 12), 1e-6);
  EXPECT_NEAR(a(86, 0), b(89, 0), 1e-6);  // right knee against left knee
}

TEST(CvaeFeaturesTest, SizesAreLdps) {
  EXPECT_EQ(kLowerFrame, 111);
  EXPECT_EQ(kUpperFrame, 171);
  EXPECT_EQ(kUpperCondition, 198);
}

TEST(CvaeFeaturesTest, PendulumByHand) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  const Eigen::MatrixXf p = PendulumFrames(person);
  ASSERT_EQ(p.rows(), 15);
  EXPECT_LT(p.col(0).head<2>().norm(), 1e-6);
  EXPECT_LT(p.col(0).tail<7>().norm(), 1e-6);
  EXPECT_NEAR(p(0, 10), person.q[10][0] - person.q[0][0], 1e-6);
  EXPECT_NEAR(p(2, 10), person.q[10][2], 1e-6);
  const Eigen::Vector3d end = TipAt(person, 10) - person.first_pose.col(0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(p(4 + i, 10), end[i], 1e-6);
  EXPECT_NEAR(p(7, 10), person.body.rod_length, 1e-6);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(p(8 + i, 10), p(i, 10) - p(i, 9), 1e-6);
}

TEST(CvaeFeaturesTest, AFrameByHand) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 3);
  BodyMotion motion = {person.first_pose, person.first_pose,
                       Placed(person.first_pose, 0.0, {0.01, 0.02, 0.0})};
  motion[1].col(kRightToe) += Eigen::Vector3d(0.0, 0.0, 0.05);
  const BodyFrames ldp = FramesOf(person, motion, CvaeCoordinates::kLdp);
  EXPECT_LT(ldp.lower.col(0).head<3>().norm(), 1e-6);
  EXPECT_NEAR(ldp.lower(0, 2), 0.01, 1e-6);  // way of the hip
  EXPECT_NEAR(ldp.upper(1, 2), 0.02, 1e-6);
  const Eigen::Vector3d toe = person.first_pose.col(kRightToe) - person.first_pose.col(0);
  EXPECT_NEAR(ldp.lower(3 + 3 * 4 + 2, 1), toe.z() + 0.05, 1e-6);    // position
  EXPECT_NEAR(ldp.lower(3 + 27 + 3 * 4 + 2, 1), 0.05 * 60.0, 1e-4);  // change, m/s
  EXPECT_NEAR(ldp.lower(3 + 3 * 0, 2), 0.01, 1e-6);                  // the hip has gone
  // Rotations at frame 0 are the identity's first two columns.
  for (int j = 0; j < 9; ++j) {
    EXPECT_NEAR(ldp.lower(3 + 54 + 6 * j, 0), 1.0, 1e-6);
    EXPECT_NEAR(ldp.lower(3 + 54 + 6 * j + 4, 0), 1.0, 1e-6);
  }
  const BodyFrames tip = FramesOf(person, motion, CvaeCoordinates::kTip);
  EXPECT_NEAR(tip.lower(3, 2), 0.0, 1e-6);
  EXPECT_NEAR(tip.lower(0, 2), 0.01, 1e-6);
}

TEST(CvaeFeaturesTest, FramesComeBackAsTheMotion) {
  const RestorationInput person =
      MovingPerson(Placed(StandingPose(), -0.8, {0.3, 0.7, 0.0}), 80, 20);
  const BodyMotion motion = RandomMotion(person, 2);
  for (const CvaeCoordinates c : {CvaeCoordinates::kTip, CvaeCoordinates::kLdp}) {
    const BodyMotion back = MotionFromFrames(person, FramesOf(person, motion, c), c);
    for (int t = 0; t < 20; ++t) EXPECT_LT((back[t] - motion[t]).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(DenseNetworkTest, LayersByHand) {
  DenseNetwork network;
  DenseLayer first, second;
  first.weights.resize(2, 2);
  first.weights << 1, 2, -1, 0;
  first.bias = Eigen::Vector2f(0.5f, 0.0f);
  second.weights.resize(1, 2);
  second.weights << 1, 10;
  second.bias = Eigen::VectorXf::Constant(1, 3.0f);
  network.layers = {first, second};
  Eigen::MatrixXf x(2, 1);
  x << 1, 1;  // hidden 3.5 and -1, ELU leaves 3.5 and exp(-1) - 1
  EXPECT_NEAR(network.Evaluate(x)(0, 0), 3.5 + 10.0 * (std::exp(-1.0) - 1.0) + 3.0, 1e-5);
}

TEST(DenseNetworkTest, ScalingThereAndBackAndWithinItsLimit) {
  Eigen::MatrixXf values(2, 4);
  values << 1, 2, 3, 4, 7, 7, 7, 7;
  const Scaling scaling = ScalingOf(values, 0.5f);
  EXPECT_FLOAT_EQ(scaling.mean[0], 2.5f);
  EXPECT_NEAR(scaling.spread[0], std::sqrt(5.0 / 3.0), 1e-6);
  EXPECT_FLOAT_EQ(scaling.spread[1], 0.5f);
  EXPECT_LT((scaling.Unscaled(scaling.Scaled(values)) - values).norm(), 1e-5);
  EXPECT_FLOAT_EQ(scaling.Scaled(values * 1000.0f)(0, 3), kLargestScaled);
}

TEST(CvaeNetworksTest, BlendedOutputsAreTheBlendedWeights) {
  const CvaeWeights weights = RandomCvae(4);
  const CvaeDecoder& d = weights.lower_decoder;
  Random random(9);
  const Eigen::MatrixXf z = RandomMatrix(kLatent, 1, 1.0, &random);
  const Eigen::MatrixXf c = RandomMatrix(kLowerFrame, 1, 1.0, &random);
  Eigen::VectorXf in(kLatent + kLowerFrame);
  in << z, c;
  const Eigen::VectorXf gate = d.gate.Evaluate(in);
  Eigen::VectorXf shares = (gate.array() - gate.maxCoeff()).exp();
  shares /= shares.sum();
  const auto layer = [&](const DenseLayer& experts, const Eigen::VectorXf& x) {
    const Eigen::Index rows = experts.weights.rows() / kExperts;
    Eigen::MatrixXf w = Eigen::MatrixXf::Zero(rows, x.size());
    Eigen::VectorXf b = Eigen::VectorXf::Zero(rows);
    for (int e = 0; e < kExperts; ++e) {
      w += shares[e] * experts.weights.middleRows(e * rows, rows);
      b += shares[e] * experts.bias.segment(e * rows, rows);
    }
    return Eigen::VectorXf(w * x + b);
  };
  const auto with_z = [&](const Eigen::MatrixXf& h) {
    Eigen::VectorXf both(kLatent + h.rows());
    both << z, h;
    return both;
  };
  Eigen::MatrixXf h = layer(d.first, in);
  ApplyElu(&h);
  h = layer(d.second, with_z(h));
  ApplyElu(&h);
  EXPECT_LT((layer(d.last, with_z(h)) - d.Evaluate(z, c)).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace pushid
