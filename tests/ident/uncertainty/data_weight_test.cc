// The weight of the data comes from the data.
#include "ident/fit/fit.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/uncertainty.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

FitOptions Estimated(const SyntheticOptions& study) {
  FitOptions options = DefaultFit(study);
  options.estimate_weights = true;
  return options;
}

SyntheticOptions Noisy(double noise) {
  SyntheticOptions study = SmallStudy();
  study.joint_noise_m = noise;
  study.noise_at_first_frame = false;
  return study;
}

// Hip and ankles have the noise; an angle that of hip and cart, a rate its difference.
TEST(DataWeight, SigmasAreThoseOfTheNoise) {
  for (double noise : {0.002, 0.005}) {
    const SyntheticOptions study = Noisy(noise);
    const auto recordings = MakePendulums(study);
    FitOptions options = Estimated(study);
    FitProblem problem(recordings, options);
    ASSERT_TRUE(SolveWeighted(&problem).solution.ok());
    const ResidualSigmas sigmas = problem.options().sigmas;
    EXPECT_NEAR(sigmas.hip / noise, 1.0, 0.1);
    // The cart is the mean of two ankles, its velocity a difference of two frames.
    EXPECT_NEAR(sigmas.velocity * kRateWeight / (noise * study.fps), 1.0, 0.1);
  }
}

TEST(DataWeight, NoResidualIsMoreExactThanAMarker) {
  const SyntheticOptions study = Noisy(0.0);
  const auto recordings = MakePendulums(study);
  FitOptions options = Estimated(study);
  options.marker_noise = 0.003;
  FitProblem problem(recordings, options);
  ASSERT_TRUE(SolveWeighted(&problem).solution.ok());
  EXPECT_DOUBLE_EQ(problem.options().sigmas.hip, 0.003);
  EXPECT_DOUBLE_EQ(problem.options().sigmas.velocity, 0.003 * study.fps / kRateWeight);
}

FitProblem EffectivelyWeighed(const std::vector<PendulumRecording>& recordings) {
  FitOptions options = UnbiasedFit(Noisy(0.003));
  return FitProblem(recordings, options);
}

// Weight over sigma squared counts: told that errors are twice as large, a frame counts
// four times as much.
TEST(DataWeight, MakesUpForSigmas) {
  const auto recordings = MakePendulums(Noisy(0.003));
  FitProblem problem = EffectivelyWeighed(recordings);
  const Solution solution = SolveWeighted(&problem).solution;
  ASSERT_TRUE(solution.ok());
  const FitPoint& point = solution.start.to;
  RecordingSums sums;
  const double weight = EstimateEffectiveWeight(problem, point, &sums);
  FitOptions weights = problem.options();
  ResidualSigmas& sigmas = weights.sigmas;
  for (double* sigma : {&sigmas.hip, &sigmas.velocity, &sigmas.angle, &sigmas.rate}) *sigma *= 2.0;
  problem.SetWeights(weights);
  const double doubled = EstimateEffectiveWeight(problem, point, &sums);
  EXPECT_NEAR(doubled / weight, 4.0, 1e-6);
}

// The recordings' sums that come with a weight are those of a problem so weighed.
TEST(DataWeight, TellsTheSumsOfRecordings) {
  const auto recordings = MakePendulums(Noisy(0.003));
  FitProblem problem = EffectivelyWeighed(recordings);
  FitPoint point = problem.NominalPoint();
  RecordingSums sums;
  FitOptions weights = problem.options();
  weights.effective_weight = 0.0;
  problem.SetWeights(weights);
  weights.effective_weight = EstimateEffectiveWeight(problem, point, &sums);
  EXPECT_EQ(sums.at.size(), 0) << "where recordings do not weigh alike";
  weights.effective_weight *= 3.0;
  problem.SetWeights(weights);
  weights.effective_weight = EstimateEffectiveWeight(problem, point, &sums);
  problem.SetWeights(weights);
  const ResidualRows rows = EvaluateRows(problem, point);
  const RecordingSums anew = SumRows(rows, point, rows.RowsOfData());
  ASSERT_EQ(sums.at, anew.at);
  const auto& [information, gradient] = anew.sums;
  EXPECT_LT((sums.sums.information - information).norm(), 1e-9 * information.norm());
  EXPECT_LT((sums.sums.gradient - gradient).norm(), 1e-9 * gradient.norm());
  EXPECT_NEAR(sums.squares, anew.squares, 1e-9 * anew.squares);

  // A solve that knows them takes the same way.
  const SolveStart plain = Refit(problem, point), knowing = Refit(problem, point, 1, sums);
  EXPECT_EQ(knowing.iterations, plain.iterations);
  EXPECT_NEAR(knowing.cost, plain.cost, 1e-9 * plain.cost);
  const std::vector<double> end = knowing.to.Flat(), same = plain.to.Flat();
  for (size_t i = 0; i < end.size(); ++i) {
    EXPECT_NEAR(end[i], same[i], 1e-6 * std::abs(same[i])) << i;
    EXPECT_EQ(knowing.recordings.at[static_cast<Eigen::Index>(i)], end[i]) << i;
  }
}

TEST(DataWeight, WithoutRecordingsTheRestOfTheCostIsLeft) {
  const SyntheticOptions study = Noisy(0.003);
  const auto recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitProblem problem(recordings, options);
  FitPoint point = problem.NominalPoint();
  for (double& value : point.shared) value *= 1.1;
  const double all = CostAt(problem, point);
  const ResidualRows rows = EvaluateRows(problem, point);
  const double data = 0.5 * rows.residuals(rows.RowsOfData()).squaredNorm();
  EXPECT_GT(data, 0.0);
  EXPECT_NEAR(CostAt(problem.WithoutRecordings(), point), all - data, 1e-9 * all);
}

// One factor on all rows leaves an unpenalized optimum where it is.
TEST(DataWeight, LeavesAnUnpenalizedOptimumWhereItWas) {
  SyntheticOptions study = Noisy(0.003);
  study.subject_spread = 0.1;
  const auto recordings = MakePendulums(study);
  FitOptions by_frame = UnbiasedFit(study), effective = by_frame;
  by_frame.effective_weight = 1.0;
  effective.effective_weight = 0.3;
  by_frame.function_tolerance = effective.function_tolerance = 1e-12;
  FitProblem frames(recordings, by_frame), independent(recordings, effective);
  const Solution a = SolveWeighted(&frames).solution;
  const Solution b = SolveWeighted(&independent).solution;
  ASSERT_TRUE(a.ok() && b.ok());
  for (size_t i = 0; i < a.start.to.shared.size(); ++i) {
    EXPECT_NEAR(a.start.to.shared[i], b.start.to.shared[i],
                1e-3 * std::max(1.0, std::abs(a.start.to.shared[i])));
  }
}

// A prior at the wrong place: exact data outweigh it, and the shares say so.
TEST(DataWeight, ExactDataOutweighAPrior) {
  SyntheticOptions study = Noisy(0.001);
  study.parameters[kMu] = 80.0;
  const auto recordings = MakePendulums(study);
  FitOptions options = Estimated(study);
  options.table[kMu].prior = Prior{20.0, 10.0};
  FitProblem problem(recordings, options);
  ASSERT_TRUE(SolveWeighted(&problem).solution.ok());
  const SolveStart refit = Refit(problem, problem.NominalPoint());
  const Uncertainty u = ComputeUncertainty(problem, refit.to);
  const Estimate* mu = FindEstimate(u.estimates, "mu");
  ASSERT_NE(mu, nullptr);
  EXPECT_NEAR(mu->value, 80.0, 4.0);
  EXPECT_GT(mu->shares.data, 0.95);
  EXPECT_LT(mu->shares.prior_pull, 0.0);
}

// Two frames tell next to nothing: what is put in decides, and the status says so.
TEST(DataWeight, WhatThePriorsHoldIsCalledSo) {
  SyntheticOptions study = TinyStudy();
  study.joint_noise_m = 0.01;
  study.frames = 6;
  const auto recordings = MakePendulums(study);
  FitOptions options = Estimated(study);
  FitProblem problem(recordings, options);
  const Solution solution = SolveWeighted(&problem).solution;
  ASSERT_TRUE(solution.ok());
  const Uncertainty u = ComputeUncertainty(problem, solution.start.to);
  const Estimate* stiffness = FindEstimate(u.estimates, "Kp_theta");
  ASSERT_NE(stiffness, nullptr);
  EXPECT_LT(stiffness->shares.data, 0.5);
  EXPECT_EQ(stiffness->status, EstimateStatus::kPriorHeld);
  // A parameter that its prior holds is no better known than the prior says.
  const Prior& prior = *options.table[kKpTheta].prior;
  EXPECT_GT(stiffness->standard_error / stiffness->value, 0.3 * prior.sigma / prior.mean);
  EXPECT_FALSE(u.held_directions.empty());
  for (const Estimate& e : u.estimates) {
    EXPECT_GE(e.shares.data, -1e-9) << e.name;
    EXPECT_NEAR(e.shares.data + e.shares.prior + e.shares.settling, 1.0, 1e-9) << e.name;
  }
}

}  // namespace
}  // namespace pushid
