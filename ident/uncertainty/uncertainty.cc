// ident: standard errors, intervals and null directions of a fit.
#include "ident/uncertainty/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/clusters.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond that a gradient for each column takes a large part of the fit's time.
constexpr Eigen::Index kMostColumnsWithCurvature = 40;

// Directions that the recordings say nothing about, whatever priors and settling simulations say: a
// number that only its prior holds is not identified.
Eigen::MatrixXd DataNullSpace(const ResidualRows& score, const Eigen::MatrixXd& scaled,
                              const std::vector<FittedColumn>& columns) {
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(score.cluster_of_row.size()); ++row) {
    const int cluster = score.cluster_of_row[row];
    const bool put_in =
        cluster == FitProblem::kPriorCluster || cluster == FitProblem::kSettlingCluster;
    if (!put_in) rows.push_back(row);
  }
  const SingularDirections data = Decompose(scaled(rows, Eigen::all));
  const int size = static_cast<int>(columns.size());
  Eigen::MatrixXd null_space(size, 0);
  for (int k = data.rank; k < size; ++k) {
    const Eigen::VectorXd direction = data.v.col(k);
    // Parameters on a bound make columns of zeros: those are not news.
    double off_bound = 0.0;
    for (int i = 0; i < size; ++i) {
      if (!columns[i].at_bound) off_bound = std::max(off_bound, std::abs(direction[i]));
    }
    if (off_bound < kTouched) continue;
    null_space.conservativeResize(size, null_space.cols() + 1);
    null_space.rightCols(1) = direction;
  }
  return null_space;
}

// Limits of EstimateStatus.
constexpr double kIdentifiedShare = 0.8;
constexpr double kMostPull = 0.5;  // standard errors
constexpr double kMostHalfWidth = 0.5;

}  // namespace

bool IsNarrow(const FittedColumn& c, double lower95, double upper95) {
  if (c.transform == Transform::kLog) {
    return 0.5 * std::log(upper95 / lower95) < std::asinh(kMostHalfWidth);
  }
  return 0.5 * (upper95 - lower95) < kMostHalfWidth * c.width;
}

namespace {

// few: too few recordings to know their scatter, or people to say anything of others.
EstimateStatus Judge(const FittedColumn& c, const Estimate& e, bool touched, bool few) {
  if (c.at_bound) return EstimateStatus::kAtBound;
  if (touched) return EstimateStatus::kUnidentifiable;
  if (e.shares.data < kHeldShare) return EstimateStatus::kPriorHeld;
  const double pull = std::abs(e.shares.prior_pull + e.shares.settling_pull);
  const bool leads = e.shares.data > kIdentifiedShare && pull < kMostPull * e.standard_error;
  return !few && leads && IsNarrow(c, e.lower95, e.upper95) ? EstimateStatus::kIdentified
                                                            : EstimateStatus::kWeak;
}

// About one fitted number, natural unit.
Interval IntervalOf(const FittedColumn& c, const ScatterOf& of) {
  const double error = c.at_bound ? 0.0 : of.standard_error;
  return {TransformSlope(c.transform, c.natural) * error,
          ToNatural(c.transform, c.fitted - of.quantile * error),
          ToNatural(c.transform, c.fitted + of.quantile * error)};
}

Estimate MakeEstimate(const FittedColumn& c, ScatterOf of, double naive_variance,
                      const Shares& shares, bool touched, bool few) {
  if (touched) of.standard_error = kInfinity;
  Estimate e;
  e.freedom = of.freedom;
  e.quantile = of.quantile;
  e.shares = shares;
  e.name = c.name;
  e.unit = c.unit;
  e.value = c.natural;
  const double slope = TransformSlope(c.transform, c.natural);
  e.shares.prior_pull *= slope;
  e.shares.settling_pull *= slope;
  e.standard_error_naive = touched ? kInfinity : slope * std::sqrt(std::max(0.0, naive_variance));
  if (c.at_bound) e.standard_error_naive = 0.0;
  const Interval interval = IntervalOf(c, of);
  e.standard_error = interval.standard_error;
  e.lower95 = interval.lower;
  e.upper95 = interval.upper;
  e.status = Judge(c, e, touched, few);
  return e;
}

Eigen::MatrixXd Correlation(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd deviation = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  Eigen::MatrixXd correlation = covariance;
  for (int i = 0; i < covariance.rows(); ++i) {
    for (int j = 0; j < covariance.cols(); ++j) {
      const double product = deviation[i] * deviation[j];
      correlation(i, j) = product > 0.0 ? covariance(i, j) / product : (i == j ? 1.0 : 0.0);
    }
  }
  return correlation;
}

// Shares of every column, pulls on the fitted scale. What ties units to each other or a network's
// weights to zero counts as the data's: it is estimated from them, or chosen by them.
std::vector<Shares> SharesOf(const Covariance& c, const Eigen::VectorXd& settling_pull) {
  const Eigen::MatrixXd& inverse = c.inverse_of_parts;
  const auto part = [&inverse](const Eigen::MatrixXd& of) {
    return (inverse * of * inverse).diagonal().eval();
  };
  const Eigen::VectorXd prior = part(c.by_prior), settling = part(c.by_settling);
  const Eigen::VectorXd prior_pull = -inverse * c.prior_gradient;
  std::vector<Shares> shares(static_cast<size_t>(inverse.rows()));
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Index k = static_cast<Eigen::Index>(i);
    const double all = inverse(k, k);
    if (all <= 0.0) continue;
    Shares& s = shares[i];
    s.prior = prior[k] / all;
    s.settling = settling[k] / all;
    s.data = 1.0 - s.prior - s.settling;
    s.prior_pull = prior_pull[k];
    s.settling_pull = settling_pull[k];
  }
  return shares;
}

// What the demand to settle moved each column by, fitted scale.
Eigen::VectorXd MovedBySettling(const Covariance& c, const Eigen::VectorXd& unit,
                                const FitPoint& point, const FitPoint* free) {
  if (free == nullptr) {
    if (c.settling_gradient.isZero(0.0)) return c.settling_gradient;
    const Eigen::MatrixXd without =
        unit.asDiagonal() * (c.by_data + c.by_prior + c.by_pooling) * unit.asDiagonal();
    const Eigen::VectorXd gradient = unit.cwiseProduct(c.settling_gradient);
    return -unit.cwiseProduct(SolveLeastNorm(without, gradient));
  }
  const std::vector<double> to = point.Flat(), from = free->Flat();
  Eigen::VectorXd moved(static_cast<Eigen::Index>(to.size()));
  for (size_t i = 0; i < to.size(); ++i) moved[static_cast<Eigen::Index>(i)] = to[i] - from[i];
  return moved;
}

// Residuals, Jacobian and, unless there are too many columns, second derivatives.
struct Evaluated {
  ResidualRows score;
  std::vector<FittedColumn> columns;
  Eigen::VectorXd unit;
  Clusters clusters;
  Clustering clustering;
};

// Steps of the gradient's differences, in a column's unit: standard errors are within 3e-5 of those
// by central differences. A likelihood's rows have Jacobians that are differences themselves, whose
// rounding a small step would magnify.
constexpr double kCurvatureStep = 3e-7, kCurvatureStepOfLikelihood = 1e-3;

Evaluated Evaluate(const FitProblem& problem, const FitPoint& point, bool curvature) {
  FitPoint copy = point;
  const FitProblem::Built built = problem.Build(&copy, 0);
  Evaluated e{EvaluateRows(built, true), FittedColumns(problem, point), {}, {}, {}};
  e.unit = Units(e.columns);
  e.clusters = MakeClusters(problem.recordings(), ClusterBy::kAuto, problem.counts());
  e.clustering = ClusterRows(problem, e.clusters, e.score);
  // Where feet step the gradient jumps: differences across a jump left no minimum, and those of a
  // shorter step know nothing of it.
  const bool steps = problem.options().model.stance == Stance::kSteps;
  if (curvature && !steps && e.unit.size() <= kMostColumnsWithCurvature) {
    const bool rolls = problem.options().likelihood == Likelihood::kTrajectory;
    const double step = rolls ? kCurvatureStep : kCurvatureStepOfLikelihood;
    AddCurvature(built, step * e.unit, !rolls, &e.score);
  }
  return e;
}

Covariance CovarianceWithoutDemand(FitProblem problem, const FitPoint& free) {
  problem.set_settling_weight(0.0);
  return CovarianceAt(problem, free);
}

}  // namespace

ScoredFit ScoreAt(const FitProblem& problem, const FitPoint& point) {
  Evaluated e = Evaluate(problem, point, true);
  return {std::move(e.score), std::move(e.unit)};
}

Covariance CovarianceAt(const FitProblem& problem, const FitPoint& point) {
  const Evaluated e = Evaluate(problem, point, true);
  return ComputeCovariance(e.score, e.unit, e.clustering);
}

Conditioning ComputeConditioning(const FitProblem& problem, const FitPoint& point,
                                 const ResidualRows& score) {
  const std::vector<FittedColumn> columns = FittedColumns(problem, point);
  const Eigen::VectorXd unit = Units(columns);
  const Covariance c = NaiveCovariance(score, unit);
  Uncertainty u;
  u.covariance = c.naive;
  u.scatter.Add(c.naive, c.naive_freedom);
  u.freedom = c.naive_freedom;
  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  return {c.directions.Condition(),
          DescribeNullSpace(problem, point, DataNullSpace(score, scaled, columns), u)};
}

Uncertainty ComputeUncertainty(const FitProblem& problem, const FitPoint& point,
                               const FitPoint* free) {
  // Where a demand moved the fit its errors are those at `free`, second derivatives and all.
  const Evaluated e = Evaluate(problem, point, free == nullptr);
  const auto& [score, columns, unit, clusters, clustering] = e;
  const int size = static_cast<int>(columns.size());
  const Covariance c = ComputeCovariance(score, unit, free == nullptr ? clustering : Clustering{});
  const Covariance spread = free == nullptr ? c : CovarianceWithoutDemand(problem, *free);

  Uncertainty u;
  u.num_residuals = score.num_data_rows;
  u.num_clusters = clusters.count();
  u.clustered_by = clusters.by;
  u.two_way = clusters.two_way;
  u.clustered = !spread.scatter.empty();
  u.num_people = clusters.people;
  u.about_people_like_them = u.clustered && clusters.draws_people;
  u.moves = spread.moves;
  u.left_out = spread.recordings;
  u.condition_number = c.directions.Condition();
  u.full_hessian = spread.full_hessian;
  u.sigma = c.sigma;
  u.freedom = u.clustered ? u.num_clusters - 1 : spread.naive_freedom;
  u.scatter = spread.scatter;
  u.these = spread.these;
  // One cluster says nothing of how clusters scatter: the posterior's width is left, in which it
  // counts as one independent frame.
  if (!u.clustered) u.scatter.Add(spread.inverse_hessian, kInfinity);
  u.covariance = u.scatter.Covariance();
  u.too_few_clusters = u.clustered && u.num_clusters - 1 < problem.map().num_shared();
  u.correlation = Correlation(u.too_few_clusters ? spread.naive : u.covariance);

  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  const Eigen::MatrixXd null_space = DataNullSpace(score, scaled, columns);
  const std::vector<Shares> shares = SharesOf(c, MovedBySettling(c, unit, point, free));
  const bool few = !u.clustered || (u.about_people_like_them && u.num_people < kFewestPeople);
  for (int i = 0; i < size; ++i) {
    const bool touched =
        null_space.cols() > 0 && null_space.row(i).cwiseAbs().maxCoeff() > kTouched;
    const bool free_of_data = touched && !columns[i].at_bound;
    u.estimates.push_back(MakeEstimate(columns[i], u.scatter.OfColumn(i), spread.naive(i, i),
                                       shares[i], free_of_data, few));
    if (!u.these.empty() && !free_of_data) {
      u.estimates.back().these = IntervalOf(columns[i], u.these.OfColumn(i));
    }
  }
  u.null_directions = DescribeNullSpace(problem, point, null_space, u);
  std::vector<bool> at_bound;
  for (const FittedColumn& column : columns) at_bound.push_back(column.at_bound);
  u.held_directions = HeldDirections(problem, point, c, at_bound);
  return u;
}

}  // namespace pushid
