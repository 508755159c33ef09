// Restorations: rigid by hand, and what holds for every kind: the order of people, where they stand
// and which way they face make no difference.
#include "models/restoration/restoration.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/models/body_samples.h"

namespace pushid {
namespace {

using Restorations = std::vector<std::unique_ptr<Restoration>>;

NormalSource Draws() {
  const auto random = std::make_shared<Random>(5);
  return [random] { return random->Normal(); };
}

// Nothing is drawn, and their hip is the rod's tip.
Restorations KindsOnTheTip() {
  Restorations kinds;
  kinds.push_back(std::make_unique<RigidRestoration>());
  kinds.push_back(std::make_unique<WindowRestoration>(RandomWindow()));
  kinds.push_back(
      std::make_unique<WindowRestoration>(RandomWindow(2, RestorationView::kNeighbours)));
  kinds.push_back(std::make_unique<CvaeRestoration>(RandomCvae()));
  kinds.push_back(
      std::make_unique<CvaeRestoration>(RandomCvae(3, {CvaeCoordinates::kTip, true, false})));
  return kinds;
}

Restorations KindsWithoutDraws() {
  Restorations kinds = KindsOnTheTip();
  kinds.push_back(std::make_unique<WindowRestoration>(RandomWindow(3, RestorationView::kPose)));
  kinds.push_back(std::make_unique<CvaeRestoration>(RandomCvae(1, {CvaeCoordinates::kLdp})));
  return kinds;
}

// LDP's chains whose latent variables are drawn, by the sampler and without a pendulum.
Restorations KindsThatDraw(const std::function<NormalSource()>& draws) {
  Restorations kinds;
  auto drawn = std::make_unique<CvaeRestoration>(RandomCvae());
  drawn->DrawLatent(draws);
  kinds.push_back(std::move(drawn));
  for (const bool halves : {true, false}) {
    const CvaeLayout layout = {CvaeCoordinates::kTip, false, halves};
    kinds.push_back(std::make_unique<CvaeRestoration>(RandomCvae(1, layout), draws));
  }
  return kinds;
}

Restorations AllKinds() {
  Restorations kinds = KindsWithoutDraws();
  for (auto& kind : KindsThatDraw(Draws)) kinds.push_back(std::move(kind));
  return kinds;
}

double Largest(const BodyMotion& a, const BodyMotion& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (size_t t = 0; t < a.size(); ++t) {
    largest = std::max(largest, (a[t] - b[t]).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(RestorationTest, RigidCarriesTheFirstPose) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 30);
  const BodyMotion motion = RigidRestoration().Restore({person})[0];
  ASSERT_EQ(motion.size(), 30u);
  EXPECT_LT((motion[0] - person.first_pose).norm(), 1e-12);
  for (int t : {7, 29}) {
    EXPECT_LT((motion[t].col(0) - TipAt(person, t)).norm(), 1e-12);
    EXPECT_LT(((motion[t].colwise() - motion[t].col(0)) -
               (person.first_pose.colwise() - person.first_pose.col(0)))
                  .norm(),
              1e-12);
  }
}

TEST(RestorationTest, APendulumTurnsWithItsTip) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 30);
  const Vector4<double> turned = TurnedPendulum(person.q[20], 0.7);
  EXPECT_LT((HipPosition(person.body, turned) - TurnAboutZ(0.7) * TipAt(person, 20)).norm(), 1e-12);
  EXPECT_LT((TurnedPendulum(turned, -0.7) - person.q[20]).norm(), 1e-12);
}

TEST(RestorationTest, TheOrderOfPeopleMakesNoDifference) {
  const RestorationInput a = MovingPerson(StandingPose(), 80, 30);
  const RestorationInput b = MovingPerson(Placed(StandingPose(), 0.4, {1, 2, 0}), 62, 30);
  const RestorationInput c = MovingPerson(Mirrored(StandingPose()), 95, 24);
  for (const auto& restoration : KindsWithoutDraws()) {
    const std::vector<BodyMotion> first = restoration->Restore({a, b, c});
    const std::vector<BodyMotion> second = restoration->Restore({c, a, b});
    // Sums in another order differ in the last bits of single precision.
    EXPECT_LT(Largest(first[0], second[1]), 1e-4) << restoration->kind();
    EXPECT_LT(Largest(first[1], second[2]), 1e-4) << restoration->kind();
    EXPECT_LT(Largest(first[2], second[0]), 1e-4) << restoration->kind();
    EXPECT_LT(Largest(first[1], restoration->Restore({b})[0]), 1e-4) << restoration->kind();
  }
}

TEST(RestorationTest, AnotherPlaceAndHeadingMoveTheMotionAlong) {
  const Eigen::Vector3d move(3.0, -2.0, 0.0);
  const double turn = 2.1;
  const RestorationInput here = MovingPerson(StandingPose(), 80, 30);
  const RestorationInput there = MovingPerson(Placed(StandingPose(), turn, move), 80, 30);
  for (const auto& restoration : AllKinds()) {
    const BodyMotion motion = restoration->Restore({here})[0];
    BodyMotion expected;
    for (const Pose& pose : motion) expected.push_back(Placed(pose, turn, move));
    EXPECT_LT(Largest(restoration->Restore({there})[0], expected), 1e-3) << restoration->kind();
  }
}

TEST(RestorationTest, TheHipGoesWithTheTip) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 30);
  for (const auto& restoration : KindsOnTheTip()) {
    const BodyMotion motion = restoration->Restore({person})[0];
    for (int t = 0; t < 30; ++t) {
      EXPECT_LT((motion[t].col(0) - TipAt(person, t)).norm(), 1e-9) << restoration->kind();
    }
  }
}

// z = mu + sigma eps: here sigma is 2 for every input.
TEST(CvaeLatentTest, ADrawIsTheMeanAndSigmaTimesTheDraw) {
  CvaeSampler sampler = RandomCvae().halves[kLowerHalf].sampler;
  sampler.log_variance.weights.setZero();
  sampler.log_variance.bias.setConstant(std::log(4.0f));
  Random random(3);
  const Eigen::MatrixXf condition = RandomMatrix(CvaeLayout().Frame(kLowerHalf), 2, 1.0, &random);
  const Eigen::MatrixXf pendulum = RandomMatrix(kPendulumFrame, 2, 1.0, &random);
  const Eigen::MatrixXf eps = RandomMatrix(kLatent, 2, 1.0, &random);
  const Eigen::MatrixXf mean = sampler.Evaluate(condition, pendulum, {});
  const Eigen::MatrixXf drawn = sampler.Evaluate(condition, pendulum, eps);
  EXPECT_LT((drawn - mean - 2.0f * eps).norm(), 1e-5f);
}

// Two people, 4 steps of 64 numbers: by the sampler once for each of two halves, 2 4 64 2 = 1024;
// without a pendulum three times, for two halves 3072 and for one 1536. Twins are drawn apart.
TEST(CvaeLatentTest, EveryPersonAndHalfHasADrawOfItsOwn) {
  int count = 0;
  const auto counted = [&count]() -> NormalSource {
    return [&count, draw = Draws()] { return ++count, draw(); };
  };
  const RestorationInput person = MovingPerson(StandingPose(), 80, 5);
  std::vector<int> counts;
  for (const auto& restoration : KindsThatDraw(counted)) {
    count = 0;
    const std::vector<BodyMotion> twins = restoration->Restore({person, person});
    EXPECT_GT(Largest(twins[0], twins[1]), 1e-3);
    counts.push_back(count);
  }
  EXPECT_EQ(counts, (std::vector<int>{1024, 3072, 1536}));
}

TEST(CvaeLatentTest, DrawsRepeatByTheirSourceAndVanishWithSigma) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  CvaeWeights weights = RandomCvae();
  const BodyMotion mean = CvaeRestoration(weights).Restore({person})[0];
  CvaeRestoration drawn(weights);
  drawn.DrawLatent(Draws);
  const BodyMotion once = drawn.Restore({person})[0];
  EXPECT_EQ(Largest(once, drawn.Restore({person})[0]), 0.0);
  EXPECT_GT(Largest(once, mean), 1e-3);
  for (CvaeSampler* sampler :
       {&weights.halves[kLowerHalf].sampler, &weights.halves[kUpperHalf].sampler}) {
    sampler->log_variance.weights.setZero();
    sampler->log_variance.bias.setConstant(-60.0f);
  }
  CvaeRestoration narrow(weights);
  narrow.DrawLatent(Draws);
  EXPECT_LT(Largest(narrow.Restore({person})[0], mean), 1e-5);
}

// A rod that shortens by 1 mm a frame while the cart rises by half of it.
RestorationInput WithShorteningRod(RestorationInput person) {
  for (size_t t = 0; t < person.q.size(); ++t) {
    const double way = 1e-3 * static_cast<double>(t);
    person.lengths.emplace_back(person.body.rod_length - way, person.body.cart_height + 0.5 * way);
  }
  return person;
}

TEST(RestorationTest, TheHipGoesWithTheTipOfARodThatMoves) {
  const RestorationInput constant = MovingPerson(StandingPose(), 80, 30);
  const RestorationInput person = WithShorteningRod(constant);
  for (const auto& restoration : KindsOnTheTip()) {
    const BodyMotion motion = restoration->Restore({person})[0];
    for (int t = 0; t < 30; ++t) {
      const Body body = {80.0, constant.body.rod_length - 1e-3 * t,
                         constant.body.cart_height + 5e-4 * t};
      EXPECT_LT((motion[t].col(0) - HipPosition(body, person.q[t])).norm(), 1e-9)
          << restoration->kind() << ", frame " << t;
    }
  }
  EXPECT_GT((TipAt(person, 29) - TipAt(constant, 29)).norm(), 0.01);
}

// What the networks see of such a rod.
TEST(RestorationTest, NetworksSeeTheLengthOfTheFrame) {
  const RestorationInput person = WithShorteningRod(MovingPerson(StandingPose(), 80, 30));
  const double now = person.body.rod_length - 0.01;
  EXPECT_NEAR(PendulumFrames(person, {})(7, 10), now, 1e-6);
  EXPECT_NEAR(PendulumFrames(person, {})(6, 10),
              TipAt(person, 10).z() - person.first_pose(2, kBodyHip), 1e-6);
  EXPECT_NEAR(WindowInputs({person}, 0, RestorationView::kPendulum)(kWindowPendulumInputs + 2, 10),
              now, 1e-6);
}

TEST(RestorationTest, OtherFrameRatesAreTheSameMotion) {
  const RestorationInput at_60 = WithShorteningRod(MovingPerson(StandingPose(), 80, 61));
  RestorationInput at_120 = at_60;
  at_120.dt = 1.0 / 120.0;
  at_120.q.clear();
  at_120.lengths.clear();
  for (int t = 0; t < 121; ++t) {
    const int low = t / 2, high = (t + 1) / 2;
    at_120.q.push_back(0.5 * (at_60.q[low] + at_60.q[high]));
    at_120.lengths.push_back(0.5 * (at_60.lengths[low] + at_60.lengths[high]));
  }
  const CvaeRestoration cvae(RandomCvae());
  const BodyMotion slow = cvae.Restore({at_60})[0], fast = cvae.Restore({at_120})[0];
  ASSERT_EQ(fast.size(), 121u);
  for (int t = 0; t < 61; ++t) EXPECT_LT((slow[t] - fast[2 * t]).cwiseAbs().maxCoeff(), 1e-4) << t;
}

}  // namespace
}  // namespace pushid
