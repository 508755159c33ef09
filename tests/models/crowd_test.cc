// A crowd moves as Rollout says, to the last bit, for any number of threads.
#include "models/crowd.h"

#include <gtest/gtest.h>

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ParameterSet<double> BlockParameters() {
  ParameterSet<double> p{};
  p[kMu] = 25.0, p[kKpTheta] = p[kKpPhi] = 1700.0, p[kKdTheta] = p[kKdPhi] = 80.0, p[kAx] = -9.0;
  p[kTailGain] = 1.0, p[kTailTime] = 0.2, p[kTailExponent] = 1.0;
  p[kContactStiffness] = 2500.0, p[kContactDistance] = 0.42, p[kContactKappa] = 0.5;
  p[kContactDamping] = 200.0, p[kContactHeight] = 0.5;
  p[kSupportFront] = p[kSupportBack] = p[kSupportSide] = 0.08, p[kFootFront] = 0.2;
  p[kStepGain] = 1.0, p[kStepOnset] = 0.1, p[kStepSwing] = 0.3;
  return p;
}

// A block of people, everybody moving a little, one pushed.
Scene Block(int rows, int columns) {
  Random random(7);
  Scene scene;
  for (int n = 0; n < rows * columns; ++n) {
    ScenePerson person;
    person.body = {random.Uniform(60, 100), random.Uniform(0.85, 1.0), 0.08};
    person.start.q = {0.43 * (n / columns) + random.Uniform(0, 0.02),
                      0.6 * (n % columns) + random.Uniform(0, 0.02), 0.0, 0.0};
    person.start.qd = {random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2), 0.0, 0.0};
    scene.people.push_back(person);
  }
  scene.pushes.push_back(
      MakeScenePush(3, 2, PushKind::kNet, HalfSinePush(scene.people[3].body, 60.0, 12, scene.dt)));
  return scene;
}

ModelOptions Options() {
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  return options;
}

class CrowdOf : public testing::TestWithParam<Stance> {};

TEST_P(CrowdOf, IsTheRolloutForAnyNumberOfThreads) {
  const Scene scene = Block(60, 50);  // enough for four threads
  constexpr int kFrames = 25;
  ModelOptions options = Options();
  options.stance = GetParam();
  RolloutPath<double> path;
  ASSERT_TRUE(
      Rollout<double>(scene, options, {BlockParameters()}, InitialVelocities(scene), kFrames, &path)
          .ok);
  for (int threads : {1, 2, 4}) {
    Crowd crowd(scene, options, {BlockParameters()}, threads);
    for (int t = 1; t < kFrames; ++t) ASSERT_TRUE(crowd.Advance().ok);
    EXPECT_EQ(crowd.frame(), kFrames - 1);
    for (int n = 0; n < scene.num_people(); ++n) {
      ASSERT_EQ(crowd.states()[n].q, path.At(kFrames - 1, n).q) << n << ", " << threads;
      ASSERT_EQ(crowd.states()[n].qd, path.At(kFrames - 1, n).qd) << n << ", " << threads;
      ASSERT_EQ(crowd.states()[n].feet.clock, path.At(kFrames - 1, n).feet.clock)
          << n << ", " << threads;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SlidingAndStanding, CrowdOf,
                         testing::Values(Stance::kSlide, Stance::kSteps));

TEST(Crowd, NamesWhoFallsAndStaysBefore) {
  Scene scene = Block(2, 3);
  ParameterSet<double> weak = BlockParameters();
  weak[kKpTheta] = -3000.0;
  std::vector<ParameterSet<double>> sets(6, BlockParameters());
  sets[4] = weak;
  scene.people[4].start.qd[2] = 0.5;
  Crowd crowd(scene, Options(), sets, 1);
  RolloutStatus status;
  while (crowd.frame() < 300 && (status = crowd.Advance()).ok) {
  }
  EXPECT_FALSE(status.ok);
  EXPECT_EQ(status.person, 4);
  EXPECT_EQ(status.quantity, "theta");
  EXPECT_EQ(status.frame, crowd.frame() + 1);
  EXPECT_LE(std::abs(crowd.states()[4].q[2]), kMaxAngle);
  // Asked again: the same, and no person has moved.
  const Vector4<double> stayed = crowd.states()[0].q;
  const RolloutStatus again = crowd.Advance();
  EXPECT_FALSE(again.ok);
  EXPECT_EQ(again.frame, status.frame);
  EXPECT_EQ(again.person, 4);
  EXPECT_EQ(crowd.states()[0].q, stayed);
}

}  // namespace
}  // namespace pushid
