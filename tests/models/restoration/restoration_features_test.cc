// The numbers that the networks see, by hand and there and back.
#include <gtest/gtest.h>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/window_restoration.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

constexpr RestorationView kPendulum = RestorationView::kPendulum;
constexpr RestorationView kViews[] = {kPendulum, RestorationView::kNeighbours,
                                      RestorationView::kPose};

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
  const Eigen::MatrixXf inputs = WindowInputs({person}, 0, kPendulum);
  ASSERT_EQ(inputs.rows(), 107);
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
  for (const RestorationView view : kViews) {
    const Eigen::MatrixXf targets = WindowTargets(person, motion, view);
    ASSERT_EQ(targets.rows(), WindowOutputRows(view));
    const BodyMotion back = MotionFromOutputs(person, targets, view);
    for (int t = 0; t < 20; ++t) EXPECT_LT((back[t] - motion[t]).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT(targets.col(0).norm(), 1e-6) << "nothing has moved at frame 0";
  }
}

TEST(WindowFeaturesTest, TheMirrorMirrorsInputsAndTargets) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20), other = Mirrored(person);
  const Eigen::MatrixXf a = WindowInputs({person}, 0, kPendulum),
                        b = WindowInputs({other}, 0, kPendulum);
  EXPECT_NEAR(a(0, 12), b(0, 12), 1e-6);
  EXPECT_NEAR(a(1, 12), -b(1, 12), 1e-6);
  EXPECT_NEAR(a(2, 12), b(2, 12), 1e-6);
  EXPECT_NEAR(a(3, 12), -b(3, 12), 1e-6);
  EXPECT_NEAR(a(86, 0), b(89, 0), 1e-6);  // right knee against left knee
}

// Three in a row along +x and one to the left of the first, who walk off.
std::vector<RestorationInput> FourPeople() {
  std::vector<RestorationInput> people;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5, 0.1, 0.0),
        Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.1, 0.6, 0.0)}) {
    people.push_back(MovingPerson(Placed(StandingPose(), 0.0, place), 60.0, 30));
  }
  // The one ahead moves a little further every frame, so that something changes.
  for (size_t t = 0; t < people[1].q.size(); ++t)
    people[1].q[t][0] += 0.01 * static_cast<double>(t);
  return people;
}

TEST(NeighbourFeaturesTest, NumbersByHand) {
  const std::vector<RestorationInput> people = FourPeople();
  const Eigen::MatrixXf inputs = NeighbourInputs(people, 0);
  ASSERT_EQ(inputs.rows(), 104);
  const auto at = inputs.col(10);
  const Eigen::Vector3d away = TipAt(people[1], 0) - TipAt(people[0], 0);
  EXPECT_NEAR(at[0], away.x(), 1e-6);  // ahead, at frame 0
  EXPECT_NEAR(at[1], away.y(), 1e-6);
  EXPECT_NEAR(at[2], people[1].body.rod_length, 1e-6);
  EXPECT_NEAR(at[3], std::exp(-away.head<2>().squaredNorm()), 1e-6);
  EXPECT_NEAR(at[4], 0.10, 1e-6);  // now: ten frames of a centimetre
  EXPECT_NEAR(at[5], 0.0, 1e-6);
  EXPECT_NEAR(at[4 + 3], 0.0, 1e-6);       // lag -12 is before the beginning
  EXPECT_NEAR(at[4 + 3 * 3], 0.16, 1e-6);  // lag 6
  EXPECT_NEAR(at[4 + 3 * 6], 0.6, 1e-4);   // 1 cm a frame
  EXPECT_NEAR(at[4 + 3 * 6 + 2], people[1].q[10][2], 1e-6);
  EXPECT_NEAR(inputs(4 + 3 * 6, 0), 0.6, 1e-4) << "at the ends as well";
  EXPECT_NEAR(inputs(4 + 3 * 6, 29), 0.6, 1e-4);
  EXPECT_EQ(at.segment(26, 26).norm(), 0.0f) << "nobody behind";
  EXPECT_GT(at[2 * 26 + 1], 0.5) << "to the left";
  EXPECT_EQ(at.segment(3 * 26, 26).norm(), 0.0f) << "nobody to the right";
}

TEST(NeighbourFeaturesTest, OrderChangesNothingAndTheMirrorExchangesLeftAndRight) {
  const std::vector<RestorationInput> people = FourPeople();
  const Eigen::MatrixXf inputs = NeighbourInputs(people, 0);
  EXPECT_EQ(inputs, NeighbourInputs({people[3], people[2], people[0], people[1]}, 2));
  std::vector<RestorationInput> others;
  for (const RestorationInput& person : people) others.push_back(Mirrored(person));
  const Eigen::MatrixXf mirrored = NeighbourInputs(others, 0);
  EXPECT_NEAR(mirrored(0, 5), inputs(0, 5), 1e-6);
  EXPECT_NEAR(mirrored(1, 5), -inputs(1, 5), 1e-6);
  EXPECT_EQ(mirrored.middleRows(2 * 26, 26).norm(), 0.0f);
  EXPECT_NEAR(mirrored(3 * 26 + 1, 5), -inputs(2 * 26 + 1, 5), 1e-6);
}

TEST(NeighbourFeaturesTest, NoNumberDependsOnPlaceOrHeading) {
  std::vector<RestorationInput> moved;
  const std::vector<RestorationInput> people = FourPeople();
  const double turn = 0.7;
  for (RestorationInput person : people) {
    person.first_pose = TurnAboutZ(turn) * person.first_pose;
    for (Vector4<double>& q : person.q) q = TurnedPendulum(q, turn);
    moved.push_back(person);
  }
  EXPECT_LT((NeighbourInputs(moved, 1) - NeighbourInputs(people, 1)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(WindowFeaturesTest, ThePoseViewSeesThePushAndNoPendulum) {
  std::vector<RestorationInput> people = FourPeople();
  for (RestorationInput& person : people) {
    person.push = {{0.8, -0.2, 0.0}, 0.3, people[0].first_pose.col(0)};
  }
  const RestorationView view = RestorationView::kPose;
  const Eigen::MatrixXf inputs = WindowInputs(people, 1, view);
  ASSERT_EQ(inputs.rows(), 32);
  EXPECT_NEAR(inputs(27, 3), 0.8, 1e-6);
  EXPECT_NEAR(inputs(28, 3), -0.2, 1e-6);
  EXPECT_NEAR(inputs(29, 3), 0.3, 1e-6);
  EXPECT_NEAR(inputs(30, 3), -0.5, 1e-6);
  EXPECT_NEAR(inputs(31, 3), -0.1, 1e-6);
  std::vector<RestorationInput> elsewhere = people;
  for (size_t t = 1; t < elsewhere[1].q.size(); ++t) elsewhere[1].q[t] += Vector4<double>::Ones();
  EXPECT_EQ(WindowInputs(elsewhere, 1, view), inputs);
}

TEST(CvaeFeaturesTest, SizesAreLdps) {
  const CvaeLayout layout;
  EXPECT_EQ(layout.Frame(kLowerHalf), 111);
  EXPECT_EQ(layout.Frame(kUpperHalf), 171);
  EXPECT_EQ(layout.Condition(kUpperHalf), 198);
  const CvaeLayout whole = {CvaeCoordinates::kTip, true, false};
  EXPECT_EQ(whole.Frame(kLowerHalf), 267);
  EXPECT_EQ(whole.num_halves(), 1);
}

TEST(CvaeFeaturesTest, PendulumByHand) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  const Eigen::MatrixXf p = PendulumFrames(person, CvaeLayout());
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
  const BodyFrames ldp = FramesOf(person, motion, {CvaeCoordinates::kLdp});
  EXPECT_LT(ldp[kLowerHalf].col(0).head<3>().norm(), 1e-6);
  EXPECT_NEAR(ldp[kLowerHalf](0, 2), 0.01, 1e-6);  // way of the hip
  EXPECT_NEAR(ldp[kUpperHalf](1, 2), 0.02, 1e-6);
  const Eigen::Vector3d toe = person.first_pose.col(kRightToe) - person.first_pose.col(0);
  EXPECT_NEAR(ldp[kLowerHalf](3 + 3 * 4 + 2, 1), toe.z() + 0.05, 1e-6);    // position
  EXPECT_NEAR(ldp[kLowerHalf](3 + 27 + 3 * 4 + 2, 1), 0.05 * 60.0, 1e-4);  // change, m/s
  EXPECT_NEAR(ldp[kLowerHalf](3 + 3 * 0, 2), 0.01, 1e-6);                  // the hip has gone
  // Rotations at frame 0 are the identity's first two columns.
  for (int j = 0; j < 9; ++j) {
    EXPECT_NEAR(ldp[kLowerHalf](3 + 54 + 6 * j, 0), 1.0, 1e-6);
    EXPECT_NEAR(ldp[kLowerHalf](3 + 54 + 6 * j + 4, 0), 1.0, 1e-6);
  }
  const BodyFrames tip = FramesOf(person, motion, {CvaeCoordinates::kTip});
  EXPECT_NEAR(tip[kLowerHalf](3, 2), 0.0, 1e-6);
  EXPECT_NEAR(tip[kLowerHalf](0, 2), 0.01, 1e-6);
}

TEST(CvaeFeaturesTest, FramesComeBackAsTheMotion) {
  const RestorationInput person =
      MovingPerson(Placed(StandingPose(), -0.8, {0.3, 0.7, 0.0}), 80, 20);
  const BodyMotion motion = RandomMotion(person, 2);
  const CvaeLayout layouts[] = {{CvaeCoordinates::kTip},
                                {CvaeCoordinates::kLdp},
                                {CvaeCoordinates::kTip, false},
                                {CvaeCoordinates::kTip, true, false},
                                {CvaeCoordinates::kTip, false, false}};
  for (const CvaeLayout& layout : layouts) {
    const BodyMotion back = MotionFromFrames(person, FramesOf(person, motion, layout), layout);
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
  const int lower = weights.layout.Frame(kLowerHalf);
  const CvaeDecoder& d = weights.halves[kLowerHalf].decoder;
  Random random(9);
  const Eigen::MatrixXf z = RandomMatrix(kLatent, 1, 1.0, &random);
  const Eigen::MatrixXf c = RandomMatrix(lower, 1, 1.0, &random);
  Eigen::VectorXf in(kLatent + lower);
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
