// How far units differ, from units that are known to differ by so much.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "models/decompositions.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

// People whose stiffness is the truth times exp(spread z), z drawn once and for all.
constexpr double kDrawn[] = {-1.52, 0.61, 0.37, -0.16, 1.24, -0.89, 0.05, 1.71, -0.43, -0.98};

double SampleDeviation(double spread) {
  double sum = 0.0, squares = 0.0;
  for (double z : kDrawn) sum += spread * z, squares += spread * spread * z * z;
  const double n = std::size(kDrawn);
  return std::sqrt((squares - sum * sum / n) / (n - 1.0));
}

std::vector<PendulumRecording> People(const SyntheticOptions& base, double spread) {
  std::vector<PendulumRecording> all;
  for (size_t i = 0; i < std::size(kDrawn); ++i) {
    SyntheticOptions study = base;
    study.subjects = 1;
    study.seed = i + 1;
    study.parameters[kKpTheta] *= std::exp(spread * kDrawn[i]);
    for (PendulumRecording& r : MakePendulums(study)) {
      r.subject_ids[0] = "P" + std::to_string(i);
      r.id = r.subject_ids[0] + "/" + r.id;
      all.push_back(r);
    }
  }
  return all;
}

// Recordings that count for what they are: every frame, with the noise that is in it.
FitOptions WeighedFit(const SyntheticOptions& study) {
  FitOptions options = UnbiasedFit(study);
  options.sigmas.hip = study.joint_noise_m;
  options.sigmas.velocity = 2.0 * study.joint_noise_m * study.fps;
  options.sigmas.angle = 2.0 * study.joint_noise_m;
  options.sigmas.rate = 4.0 * study.joint_noise_m * study.fps;
  options.effective_weight = 1.0;
  options.pool = "Kp_theta";
  options.pool_by = kSubjectUnit;
  options.pooling_sigma.reset();
  EXPECT_FALSE(PoolParameters(&options));
  return options;
}

SyntheticOptions Study() {
  SyntheticOptions study = TinyStudy();
  study.noise_at_first_frame = false;
  return study;
}

TEST(PoolingSpread, OfUnitsThatDifferComesBack) {
  const SyntheticOptions study = Study();
  for (double spread : {0.1, 0.3}) {
    FitOptions options = WeighedFit(study);
    const auto recordings = People(study, spread);
    FitProblem problem(recordings, options);
    const Solution solution = SolveWeighted(&problem).solution;
    ASSERT_TRUE(solution.ok());
    EXPECT_TRUE(solution.start.converged);
    EXPECT_NEAR(problem.options().table[kKpTheta].pooling_sigma / SampleDeviation(spread), 1.0,
                0.1);
  }
}

// The update is a short cut; where it ends, EM's own equation must hold, and there is nothing left
// to update.
TEST(PoolingSpread, EndsWhereEmStandsStill) {
  const SyntheticOptions study = Study();
  FitOptions options = WeighedFit(study);
  const auto recordings = People(study, 0.1);
  FitProblem problem(recordings, options);
  FitPoint point = SolveWeighted(&problem).solution.start.to;
  const double sigma = problem.options().table[kKpTheta].pooling_sigma;
  const ResidualRows blocks = EvaluateRows(problem, point);
  const Eigen::MatrixXd covariance = Inverse(blocks.jacobian.transpose() * blocks.jacobian);
  double mean = 0.0;
  Eigen::Index column = static_cast<Eigen::Index>(point.shared.size());
  for (const auto& [unit, deviations] : point.unit) {
    mean += deviations[0] * deviations[0] + covariance(column, column);
    ++column;
  }
  mean /= static_cast<double>(point.unit.size());
  EXPECT_NEAR(std::sqrt(mean) / sigma, 1.0, 0.01);
  FitOptions weights = problem.options();
  EXPECT_LT(UpdatePoolingSpread(problem, point, &weights), 0.01);
}

TEST(PoolingSpread, IsSmallWhereUnitsAreAlike) {
  const SyntheticOptions study = Study();
  FitOptions options = WeighedFit(study);
  const auto recordings = People(study, 0.0);
  FitProblem problem(recordings, options);
  ASSERT_TRUE(SolveWeighted(&problem).solution.ok());
  const double sigma = problem.options().table[kKpTheta].pooling_sigma;
  EXPECT_LT(sigma, 0.04);
  EXPECT_GE(sigma, kLeastPoolingSigma);
}

TEST(PoolingSpread, ThatWasGivenStays) {
  const SyntheticOptions study = Study();
  FitOptions options = WeighedFit(study);
  options.pooling_sigma = 0.05;
  ASSERT_FALSE(PoolParameters(&options));
  const auto recordings = People(study, 0.3);
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.options.table[kKpTheta].pooling_sigma, 0.05);
}

// A parameter on an identity scale: the spread counts in its typical sizes.
TEST(PoolingSpread, OfAnIdentityScaleIsInTypicalSizes) {
  ParameterTable table = BaseTable();
  table[kMu].pooling_sigma = table[kKpTheta].pooling_sigma = 0.2;
  EXPECT_EQ(PoolingSigma(table[kMu]), 0.2 * table[kMu].scale);
  EXPECT_EQ(PoolingSigma(table[kKpTheta]), 0.2);
}

}  // namespace
}  // namespace pushid
