// Covariances against their definitions, computed here in other ways.
#include "ident/uncertainty/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "ident/fit/fit.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

struct Solved {
  std::vector<PendulumRecording> recordings;
  FitOptions options;
  std::unique_ptr<FitProblem> problem;
  FitPoint point;
  ResidualRows score;
  Uncertainty uncertainty;
};

// Three parameters, six recordings; priors or not.
std::unique_ptr<Solved> SolveSmall(int recordings, double prior_sigma) {
  auto solved = std::make_unique<Solved>();
  const SyntheticOptions study = TinyStudy();
  solved->recordings = MakePendulums(study);
  solved->recordings.resize(recordings);
  solved->options = UnbiasedFit(study);
  // With one person recordings are the clusters.
  for (PendulumRecording& r : solved->recordings) r.subject_ids = {"S1"};
  for (ParameterSpec& spec : solved->options.table.specs) {
    spec.free = spec.id == kMu || spec.id == kKpTheta || spec.id == kTailGain;
    if (!spec.free) spec.nominal = study.parameters[spec.id];
    if (spec.free && prior_sigma > 0.0)
      spec.prior = Prior{spec.nominal, prior_sigma * spec.nominal};
  }
  solved->problem = std::make_unique<FitProblem>(solved->recordings, solved->options);
  const Solution solution = Solve(*solved->problem);
  EXPECT_TRUE(solution.ok());
  solved->point = solution.start.to;
  FitPoint copy = solved->point;
  solved->score = EvaluateRows(solved->problem->Build(&copy, 0));
  solved->uncertainty = ComputeUncertainty(*solved->problem, solved->point);
  return solved;
}

std::vector<int> RowsOf(const ResidualRows& score, int cluster, bool inside) {
  return score.RowsWhere([&](int c) { return (c == cluster) == inside; });
}

void ExpectRelativelyEqual(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double tolerance) {
  ASSERT_EQ(a.rows(), b.rows());
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < a.cols(); ++j) {
      EXPECT_NEAR(a(i, j), b(i, j), tolerance * std::sqrt(b(i, i) * b(j, j))) << i << " " << j;
    }
  }
}

double CostOf(const Solved& s, const std::vector<double>& shared) {
  FitPoint point = s.point;
  point.shared = shared;
  double cost = 0.0;
  s.problem->Build(&point, 0).problem->Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

// Second differences of the cost itself.
TEST(Uncertainty, HessianIsThatOfTheCost) {
  const auto s = SolveSmall(6, 0.5);
  const Covariance c = CovarianceAt(*s->problem, s->point);
  ASSERT_TRUE(c.full_hessian);
  const Eigen::MatrixXd hessian = Inverse(c.inverse_hessian);
  Eigen::Vector3d step;
  for (int i = 0; i < 3; ++i) step[i] = 1e-2 * std::sqrt(1.0 / hessian(i, i));
  const auto cost = [&](int i, double a, int j, double b) {
    std::vector<double> shared = s->point.shared;
    shared[i] += a * step[i];
    shared[j] += b * step[j];
    return CostOf(*s, shared);
  };
  Eigen::MatrixXd differences(3, 3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      differences(i, j) =
          (cost(i, 1, j, 1) - cost(i, 1, j, -1) - cost(i, -1, j, 1) + cost(i, -1, j, -1)) /
          (4.0 * step[i] * step[j]);
    }
  }
  ExpectRelativelyEqual(hessian, differences, 1e-3);
}

TEST(Uncertainty, CurvatureIsTheSameFromOneSideAndFromBoth) {
  const auto s = SolveSmall(6, 0.5);
  const Eigen::VectorXd unit = Units(FittedColumns(*s->problem, s->point));
  FitPoint copy = s->point;
  const FitProblem::Built built = s->problem->Build(&copy, 0);
  ResidualRows ahead = EvaluateRows(built), both = ahead;
  AddCurvature(built, 3e-7 * unit, false, &ahead);
  AddCurvature(built, 1e-4 * unit, true, &both);
  const Eigen::MatrixXd squares = both.jacobian.transpose() * both.jacobian;
  EXPECT_GT(both.curvature.norm(), 1e-3 * squares.norm());
  ExpectRelativelyEqual(squares + ahead.curvature, squares + both.curvature, 1e-5);
}

// Bell and McCaffrey's correction by its definition, on the rows of each recording.
TEST(Uncertainty, ClusteredIsBiasReduced) {
  for (double prior : {0.0, 0.5}) {
    const auto s = SolveSmall(6, prior);
    const int groups = static_cast<int>(s->score.clusters.size());
    ASSERT_EQ(groups, 6);
    const Eigen::MatrixXd inverse = CovarianceAt(*s->problem, s->point).inverse_hessian;
    Eigen::MatrixXd moves(3, groups);
    for (int g = 0; g < groups; ++g) {
      const std::vector<int> rows = RowsOf(s->score, s->score.clusters[g], true);
      const Eigen::MatrixXd own = s->score.jacobian(rows, Eigen::all);
      const Eigen::MatrixXd hat = own * inverse * own.transpose();
      const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(hat.rows(), hat.cols()) - hat;
      moves.col(g) = inverse * own.transpose() * DecomposeSymmetric(rest).InverseSqrt() *
                     s->score.residuals(rows);
    }
    moves.colwise() -= moves.rowwise().mean().eval();
    // The prior's centre is a draw of its own width.
    const Eigen::MatrixXd put_in =
        s->score.jacobian(s->score.RowsOf(FitProblem::kPriorCluster), Eigen::all) * inverse;
    ExpectRelativelyEqual(s->uncertainty.covariance,
                          moves * moves.transpose() + put_in.transpose() * put_in, 1e-4);
  }
}

// One Newton step is what leaving a recording out really moves.
TEST(Uncertainty, MovesAreCloseToRefitting) {
  const auto s = SolveSmall(6, 0.0);
  const Eigen::MatrixXd moves = CovarianceAt(*s->problem, s->point).moves;
  for (int g = 0; g < 6; ++g) {
    std::vector<PendulumRecording> others = s->recordings;
    others.erase(others.begin() + g);
    const FitProblem problem(others, s->options);
    const FitPoint point = SolveFrom(problem, s->point, "nominal", nullptr).to;
    for (int i = 0; i < 3; ++i) {
      const double error = std::sqrt(s->uncertainty.covariance(i, i));
      const double real = (point.shared[i] - s->point.shared[i]) / error;
      EXPECT_NEAR(moves(i, g) / error, real, 0.05 + 0.4 * std::abs(real)) << g << " " << i;
    }
  }
}

TEST(Uncertainty, NaiveIsTheTextbookOne) {
  const auto s = SolveSmall(6, 0.0);
  const Eigen::MatrixXd& j = s->score.jacobian;
  int rows = 0;  // before they were condensed
  for (const PendulumRecording& r : s->recordings) rows += (r.num_frames() - 1) * kFrameResiduals;
  const double variance = s->score.residuals.squaredNorm() / (rows - 3.0);
  EXPECT_NEAR(s->uncertainty.sigma, std::sqrt(variance), 1e-12);
  EXPECT_EQ(s->uncertainty.num_residuals, rows);
  const Eigen::MatrixXd expected = variance * Inverse(j.transpose() * j);
  const auto& fitted = s->problem->map().fitted;
  for (int i = 0; i < 3; ++i) {
    const Estimate& e = s->uncertainty.estimates[i];
    const double slope = TransformSlope(fitted[i].transform, e.value);
    EXPECT_NEAR(e.standard_error_naive / (slope * std::sqrt(expected(i, i))), 1.0, 1e-6) << e.name;
  }
}

TEST(Uncertainty, IntervalsAndCorrelation) {
  const auto s = SolveSmall(6, 0.0);
  const Uncertainty& u = s->uncertainty;
  EXPECT_TRUE(u.clustered);
  EXPECT_EQ(u.num_clusters, 6);
  EXPECT_EQ(u.freedom, 5);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(u.correlation(i, i), 1.0, 1e-12);
    for (int j = 0; j < 3; ++j) {
      EXPECT_LE(std::abs(u.correlation(i, j)), 1.0 + 1e-12);
      EXPECT_NEAR(u.correlation(i, j), u.correlation(j, i), 1e-12);
      EXPECT_NEAR(u.covariance(i, j),
                  u.correlation(i, j) * std::sqrt(u.covariance(i, i) * u.covariance(j, j)),
                  1e-12 * std::sqrt(u.covariance(i, i) * u.covariance(j, j)));
    }
  }
  const Estimate& plain = *FindEstimate(u.estimates, "mu");
  const double half = plain.quantile * plain.standard_error;
  EXPECT_LE(plain.freedom, 5.0 + 1e-9);
  EXPECT_NEAR(plain.upper95 - plain.value, half, 1e-9);
  EXPECT_NEAR(plain.value - plain.lower95, half, 1e-9);
  // Fitted as a log: by the same factor up and down.
  const Estimate& log = *FindEstimate(u.estimates, "Kp_theta");
  EXPECT_NEAR(log.upper95 / log.value, log.value / log.lower95, 1e-9);
}

// Two people, three pushes each: errors about people like them, and about these two.
TEST(Uncertainty, TellsThesePeopleFromPeopleLikeThem) {
  const auto s = SolveSmall(6, 0.5);
  const std::vector<PendulumRecording> of_two = MakePendulums(TinyStudy());
  const FitProblem problem(of_two, s->options);
  const Uncertainty people = ComputeUncertainty(problem, s->point);
  EXPECT_TRUE(people.about_people_like_them);
  EXPECT_EQ(people.num_people, 2);
  EXPECT_FALSE(s->uncertainty.about_people_like_them);
  for (int i = 0; i < 3; ++i) {
    const Estimate &like = people.estimates[i], &these = s->uncertainty.estimates[i];
    EXPECT_LE(like.freedom, 1.0) << like.name;
    EXPECT_GE(like.quantile, 1.95) << like.name;
    EXPECT_NE(like.status, EstimateStatus::kIdentified) << like.name;  // of two people nothing is
    ASSERT_TRUE(like.these) << like.name;
    EXPECT_NEAR(like.these->standard_error / these.standard_error, 1.0, 1e-9) << like.name;
    EXPECT_NEAR(like.these->upper / these.upper95, 1.0, 1e-9) << like.name;
    EXPECT_FALSE(these.these) << like.name;  // said once
  }
}

TEST(Uncertainty, CombineAddsByTheDeltaMethod) {
  const auto s = SolveSmall(6, 0.0);
  const Uncertainty& u = s->uncertainty;
  const Combination c =
      Combine(*s->problem, s->point, u, {"2 mu - Kp", "", {{kMu, 2.0}, {kKpTheta, -1.0}}});
  const double mu = u.estimates[0].value, kp = u.estimates[1].value;
  EXPECT_NEAR(c.value, 2.0 * mu - kp, 1e-9);
  const Eigen::Vector3d gradient(2.0, -kp, 0.0);  // Kp_theta is fitted as a log
  EXPECT_NEAR(c.standard_error, std::sqrt(gradient.dot(u.covariance * gradient)), 1e-9);
}

// A lean term of typical size 10 with a prior of +- 10: what makes it narrow is its interval alone.
TEST(Uncertainty, TheEstimateDoesNotMakeItsOwnIntervalNarrow) {
  EXPECT_TRUE(IsNarrow(Transform::kIdentity, 10.0, -9.0, 0.9));
  EXPECT_FALSE(IsNarrow(Transform::kIdentity, 10.0, -35.0, -24.9))
      << "half of 10.1 is more than half of the prior's 10";
  EXPECT_TRUE(IsNarrow(Transform::kLog, 1.0, 1000.0, 2600.0));
  EXPECT_TRUE(IsNarrow(Transform::kLog, 1.0, 10.0, 26.0)) << "a ratio does not depend on the size";
  EXPECT_FALSE(IsNarrow(Transform::kLog, 1.0, 1000.0, 2640.0));
}

TEST(Uncertainty, ATotalErrorIsNeverLessThanThatOfTheData) {
  const Interval total = WidenedTo({0.2, -1.0, 1.0}, {0.1, -0.5, 2.0});
  EXPECT_EQ(total.standard_error, 0.2);
  EXPECT_EQ(total.lower, -1.0);
  EXPECT_EQ(total.upper, 2.0);
}

TEST(Uncertainty, ASingleRecordingIsNotClustered) {
  const auto s = SolveSmall(1, 0.0);
  EXPECT_FALSE(s->uncertainty.clustered);
  EXPECT_EQ(s->uncertainty.num_clusters, 1);
  for (const Estimate& e : s->uncertainty.estimates) {
    EXPECT_GT(e.standard_error, 0.0);
    EXPECT_NE(e.status, EstimateStatus::kIdentified) << e.name;
  }
  const FitResult result = Fit(s->recordings, s->options);
  bool warned = false;
  for (const Warning& w : result.warnings) {
    warned = warned || w.text.find("a single recording") != std::string::npos;
  }
  EXPECT_TRUE(warned);
  EXPECT_NE(result.verdict.none_identified.find("there is one recording"), std::string::npos);
}

TEST(Uncertainty, AtABoundHasNoErrorAndSaysSo) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  options.table[kTailGain].upper = 0.8;  // the truth is 1
  options.table[kTailGain].nominal = 0.5;
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  const Estimate& e = *FindEstimate(result.estimates, "tail_gain");
  EXPECT_EQ(e.status, EstimateStatus::kAtBound);
  EXPECT_NEAR(e.value, 0.8, 1e-6);
  EXPECT_EQ(e.standard_error, 0.0);
  EXPECT_TRUE(result.uncertainty.null_directions.empty());
  bool warned = false;
  for (const Warning& w : result.warnings) {
    warned = warned || w.text.find("tail_gain is at its bound") != std::string::npos;
  }
  EXPECT_TRUE(warned);
}

TEST(StudentQuantile, AgainstTables) {
  EXPECT_NEAR(StudentQuantile95(1), 12.706, 5e-4);
  EXPECT_NEAR(StudentQuantile95(2), 4.303, 5e-4);
  EXPECT_NEAR(StudentQuantile95(5), 2.571, 5e-4);
  EXPECT_NEAR(StudentQuantile95(31), 2.040, 5e-4);
  EXPECT_NEAR(StudentQuantile95(1000), 1.962, 5e-4);
  EXPECT_NEAR(StudentQuantile95(1000000), 1.960, 5e-4);
}

}  // namespace
}  // namespace pushid
