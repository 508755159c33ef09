// The demand to settle is tested against the data.

#include "ident/fit/fit.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

SyntheticOptions Truth(double mu, double stiffness, double a_x) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.002;
  study.parameters[kMu] = mu;
  study.parameters[kKpTheta] = stiffness;
  study.parameters[kAx] = a_x;
  return study;
}

// So few and noisy frames that they contradict little.
SyntheticOptions Scarce(SyntheticOptions study, int pushes, int frames, double noise) {
  study.subjects = 3;
  study.recordings_per_subject = pushes;
  study.frames = frames;
  study.joint_noise_m = noise;
  return study;
}

FitResult FitOf(const SyntheticOptions& study) {
  const auto recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  EXPECT_FALSE(PrepareFit(recordings, &options));
  return Fit(recordings, options);
}

// The feet are slow to stop, which exact data know.
TEST(WeightedSolve, DataThatContradictTheDemandAreFollowed) {
  const SyntheticOptions study = Truth(12.0, 2200.0, -6.0);
  const FitResult result = FitOf(study);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result.uncertainty.settling.binds);
  EXPECT_TRUE(result.uncertainty.settling.contradicted);
  EXPECT_GT(result.uncertainty.settling.free_seconds, 2.0);
  EXPECT_EQ(result.options.settling_weight, 0.0);
  EXPECT_NEAR(result.parameters[kMu], study.parameters[kMu], 2.0);
  const bool told =
      std::any_of(result.warnings.begin(), result.warnings.end(), [](const Warning& warning) {
        return warning.text.find("contradicts the data") != std::string::npos;
      });
  EXPECT_TRUE(told);
}

TEST(WeightedSolve, WhoSettlesIsNotMoved) {
  const SyntheticOptions study = Truth(34.0, 1800.0, -10.5);
  const FitResult result = FitOf(study);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result.behaviour.settles);
  EXPECT_FALSE(result.uncertainty.settling.binds);
  for (const Estimate& e : result.uncertainty.estimates) {
    EXPECT_EQ(e.shares.settling, 0.0) << e.name;
    EXPECT_EQ(e.shares.settling_pull, 0.0) << e.name;
  }
  FitOptions without = MakePreset("tail").value();
  without.settling_weight = 0.0;
  const auto recordings = MakePendulums(study);
  ASSERT_FALSE(PrepareFit(recordings, &without));
  EXPECT_NEAR(Fit(recordings, without).parameters[kMu], result.parameters[kMu], 1e-3);
}

// Three recordings, noisy and short, do not contradict the demand: it holds.
TEST(WeightedSolve, ADemandThatIsNotContradictedHolds) {
  const SyntheticOptions study = Scarce(Truth(25.0, 1800.0, -9.0), 1, 20, 0.03);
  const FitResult result = FitOf(study);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result.uncertainty.settling.holds());
  EXPECT_GE(result.uncertainty.settling.rise, 0.0);
  EXPECT_TRUE(result.behaviour.settles);
  const Estimate* mu = FindEstimate(result.uncertainty.estimates, "mu");
  ASSERT_NE(mu, nullptr);
  EXPECT_GT(std::abs(mu->shares.settling_pull), 0.0);
  // How hard the demand is pressed is no knowledge of mu.
  FitOptions pressed = MakePreset("tail").value();
  pressed.settling_weight = 90.0;
  const auto recordings = MakePendulums(study);
  ASSERT_FALSE(PrepareFit(recordings, &pressed));
  const FitResult harder = Fit(recordings, pressed);
  ASSERT_TRUE(harder.uncertainty.settling.holds());
  const double error = FindEstimate(harder.uncertainty.estimates, "mu")->standard_error;
  EXPECT_NEAR(error / mu->standard_error, 1.0, 0.05);
}

// Feet that drive the person: a model fitted to them falls. The demand is met, or it is dropped
// and the result says so; and nobody knows mu to a hundredth.
TEST(WeightedSolve, ADemandThatCannotBeMetIsNotCalledHeld) {
  for (double mu : {-100.0, -50.0}) {
    const SyntheticOptions study = Scarce(Truth(mu, 800.0, -2.0), 2, 25, 0.02);
    const FitResult result = FitOf(study);
    ASSERT_TRUE(result.ok());
    const SettlingDemand& settling = result.uncertainty.settling;
    EXPECT_TRUE(settling.binds) << mu;
    if (settling.holds()) {
      EXPECT_TRUE(result.behaviour.settles) << mu;
    } else {
      EXPECT_EQ(result.options.settling_weight, 0.0) << mu;
    }
    EXPECT_GT(FindEstimate(result.uncertainty.estimates, "mu")->standard_error, 1.0) << mu;
  }
}

}  // namespace
}  // namespace pushid
