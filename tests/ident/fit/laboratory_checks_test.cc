// Parts of a laboratory that do not go together are refused, with what to leave out.
#include <gtest/gtest.h>

#include "ident/fit/fit_setup.h"
#include "models/learned_terms.h"
#include "tests/ident/laboratory_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kPeriod = 0.02;
constexpr int kFrames = 100;

// One person who stands on ground that moves (tilt: rad, beside a shift), over platforms.
PendulumRecording OnPlatform(double tilt) {
  Scene scene = StandingScene(kPeriod);
  std::vector<GroundPose> poses;
  for (int t = 0; t < kFrames; ++t) {
    const double moved = 0.5 - 0.5 * std::cos(M_PI * t / kFrames);
    poses.emplace_back(0.02 * moved, 0.0, tilt * moved, 0.0);
  }
  scene.ground = GroundThrough(poses, kPeriod);
  return RecordingOf(scene, StandingOptions(), StandingGains(1500.0, 350.0), kFrames, "anna", true);
}

FitOptions WithTable() {
  FitOptions options;
  options.table = BaseTable();
  return options;
}

std::string Refused(const PendulumRecording& recording, const FitOptions& options) {
  const MaybeError error = CheckLaboratory({recording}, options);
  return error ? error->ToString() : "";
}

TEST(LaboratoryChecks, WhatGoesTogetherIsNotRefused) {
  FitOptions options = WithTable();
  options.model.stance = Stance::kFixed;
  options.model.delay = Delay::kOne;
  EXPECT_EQ(Refused(OnPlatform(0.01), options), "");
}

TEST(LaboratoryChecks, ALateDifferenceOfVelocities) {
  FitOptions options = WithTable();
  options.model.delay = Delay::kOne;
  options.model.cart_derivative = CartDerivative::kBackward;
  EXPECT_TRUE(Contains(Refused(OnPlatform(0.0), options),
                       "--delay and the derivative of the cart's velocity"));
}

TEST(LaboratoryChecks, PlatformsAreNoSingleSteps) {
  FitOptions options = WithTable();
  options.likelihood = Likelihood::kTransition;
  const std::string told = Refused(OnPlatform(0.0), options);
  EXPECT_TRUE(Contains(told, "recording anna has force_plates")) << told;
  EXPECT_TRUE(Contains(told, "--likelihood=transition")) << told;
  PendulumRecording without = OnPlatform(0.0);
  without.plates.clear();
  EXPECT_EQ(Refused(without, options), "");
}

TEST(LaboratoryChecks, RodsThatMove) {
  FitOptions options = WithTable();
  LearnedTerms learned;
  learned.rod.kind = RodKind::kLdp;
  options.model.learned = std::make_shared<const LearnedTerms>(learned);
  ASSERT_TRUE(RodMoves(options.model));
  EXPECT_TRUE(Contains(Refused(OnPlatform(0.0), options), "no law of --rod"));
  PendulumRecording still = OnPlatform(0.0);
  still.scene.ground = {};
  EXPECT_TRUE(Contains(Refused(still, options), "leave --rod out"));
}

TEST(LaboratoryChecks, PeopleWhoTouch) {
  FitOptions options = WithTable();
  options.model.interaction.spring = true;
  ASSERT_TRUE(options.model.interaction.Any());
  PendulumRecording pair = OnPlatform(0.02);
  pair.hip.push_back(pair.hip[0]);
  EXPECT_TRUE(Contains(Refused(pair, options), "on ground that tilts"));
  pair.scene.ground = OnPlatform(0.0).scene.ground;
  EXPECT_TRUE(Contains(Refused(pair, options), "force_plates and several people"));
  pair.plates.clear();
  EXPECT_EQ(Refused(pair, options), "");
}

}  // namespace
}  // namespace pushid
