// The demand to settle is tested against the data.
#include "ident/results/weighted_solve.h"

#include "ident/results/fit.h"
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
      std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
        return warning.find("contradict the demand to settle") != std::string::npos;
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

// Of three recordings, noisy and short, nothing contradicts the demand: it holds.
TEST(WeightedSolve, ADemandThatIsNotContradictedHolds) {
  SyntheticOptions study = Truth(25.0, 1800.0, -9.0);
  study.subjects = 3;
  study.recordings_per_subject = 1;
  study.frames = 20;
  study.joint_noise_m = 0.03;
  const FitResult result = FitOf(study);
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result.uncertainty.settling.contradicted);
  EXPECT_TRUE(result.behaviour.settles);
}

// Weights change what a cost counts: starts compare by those of the best alone.
TEST(WeightedSolve, StartsAreComparedByTheSameWeights) {
  const SyntheticOptions study = Truth(34.0, 1800.0, -10.5);
  const auto recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  options.num_starts = 4;
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result.starts.size(), 4u);
  int same = 0;
  for (const SolveStart& start : result.starts) {
    if (!start.usable) continue;
    EXPECT_GE(start.cost, result.cost);
    same += start.cost < 1.001 * result.cost;
  }
  EXPECT_GE(same, 3);
}

}  // namespace
}  // namespace pushid
