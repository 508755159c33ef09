// ident: covariance on the identified subspace, by singular values of the scaled Jacobian.
#include "ident/uncertainty/covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/problem/statistics.h"
#include "ident/solver/structured_secants.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

// The difference of two-way clustering need not be positive: negative eigenvalues become zero.
Eigen::MatrixXd WithoutNegative(const Eigen::MatrixXd& covariance) {
  const SymmetricEigen eigen = DecomposeSymmetric(covariance);
  const Eigen::MatrixXd& v = eigen.vectors;
  return v * eigen.values.cwiseMax(0.0).asDiagonal() * v.transpose();
}

// H^-1 s_g G / (G - 1) for each recording.
Eigen::MatrixXd LeftOutMoves(const ResidualRows& score, const Eigen::MatrixXd& inverse_hessian) {
  const double groups = static_cast<double>(score.clusters.size());
  Eigen::MatrixXd moves(inverse_hessian.cols(), score.clusters.size());
  for (size_t g = 0; g < score.clusters.size(); ++g) {
    const Eigen::VectorXd gradient = score.Gradient(score.RowsOf(score.clusters[g]));
    moves.col(g) = groups / (groups - 1.0) * inverse_hessian * gradient;
  }
  return moves;
}

// The clusters of both ways together: pairs that occur.
RowClusters Crossed(const RowClusters& first, const RowClusters& second) {
  RowClusters both;
  std::map<std::pair<int, int>, int> index;
  for (size_t row = 0; row < first.of_row.size(); ++row) {
    const int a = first.of_row[row], b = second.of_row[row];
    both.of_row.push_back(
        a < 0 ? -1 : index.emplace(std::pair(a, b), static_cast<int>(index.size())).first->second);
  }
  both.count = static_cast<int>(index.size());
  return both;
}

void SplitHessian(const ResidualRows& score, const Eigen::MatrixXd& back, Covariance* c) {
  const std::vector<int> prior = score.RowsOf(FitProblem::kPriorCluster);
  const std::vector<int> settling = score.RowsOf(FitProblem::kSettlingCluster);
  c->by_data = score.robust_jacobian.size() > 0
                   ? Eigen::MatrixXd(score.robust_jacobian.transpose() * score.robust_jacobian)
                   : score.Information(score.RowsOfData());
  c->by_prior = score.Information(prior);
  c->by_settling = score.Information(settling);
  c->by_pooling = score.Information(score.RowsOf(FitProblem::kPoolingCluster)) +
                  score.Information(score.RowsOf(FitProblem::kNetworkCluster));
  const Eigen::MatrixXd sum =
      back.transpose() * (c->by_data + c->by_prior + c->by_settling + c->by_pooling) * back;
  c->inverse_of_parts = back * SolveSymmetric(sum, Eigen::MatrixXd(back.transpose()));
  c->prior_gradient = score.Gradient(prior);
  c->settling_gradient = score.Gradient(settling);
}

// What the recordings scatter, one way or two.
Scatter::Part DataScatter(const ResidualRows& score, const Clustering& clustering,
                          const ClusterScores& first, const Eigen::MatrixXd& back,
                          const Eigen::MatrixXd& hessian) {
  const ClusteredCovariance one = Cr2(first, hessian, back);
  Eigen::MatrixXd inner = one.covariance;
  if (clustering.line_ups.count > 0) {
    const ClusteredCovariance two = Cr2(GatherScores(score, clustering.line_ups, back), hessian,
                                        Eigen::MatrixXd(0, back.cols()));
    const ClusterScores both =
        GatherScores(score, Crossed(clustering.first, clustering.line_ups), back);
    const Eigen::MatrixXd moves = SolveSymmetric(hessian, both.scores);
    inner = WithoutNegative(one.covariance + two.covariance - moves * moves.transpose());
  }
  Eigen::VectorXd freedom = one.freedom;
  if (clustering.line_ups.count > 0) {  // as the fewer of the two have
    freedom = freedom.cwiseMin(std::max(1.0, clustering.line_ups.count - 1.0));
  }
  return {back * inner * back.transpose(), freedom};
}

// Empty with fewer than two clusters. inverse_hessian: in the columns as they came.
Scatter ClusteredScatter(const ResidualRows& score, const Clustering& clustering,
                         const Eigen::MatrixXd& back, const Eigen::MatrixXd& hessian,
                         const Eigen::MatrixXd& inverse_hessian) {
  Scatter scatter;
  if (clustering.first.count < 2) return scatter;
  const ClusterScores first = GatherScores(score, clustering.first, back);
  if (first.scores.cols() < 2) return scatter;
  scatter.parts.push_back(DataScatter(score, clustering, first, back, hessian));
  const auto add = [&](int cluster, double freedom) {
    scatter.Add(inverse_hessian * score.Information(score.RowsOf(cluster)) * inverse_hessian,
                freedom);
  };
  constexpr double kCertain = std::numeric_limits<double>::infinity();
  if (clustering.priors_scatter) add(FitProblem::kPriorCluster, kCertain);
  if (clustering.pooled_units > 1) add(FitProblem::kPoolingCluster, clustering.pooled_units - 1.0);
  return scatter;
}

}  // namespace

RecordingSums SumRows(const ResidualRows& score, const FitPoint& point,
                      const std::vector<int>& rows) {
  const std::vector<double> at = point.Flat();
  return {Eigen::VectorXd::Map(at.data(), score.jacobian.cols()),
          score.residuals(rows).squaredNorm(),
          {score.Information(rows), score.Gradient(rows)}};
}

double SingularDirections::Condition() const {
  return rank > 0 ? singular[0] / singular[rank - 1] : std::numeric_limits<double>::infinity();
}

SingularDirections Decompose(const Eigen::MatrixXd& jacobian, double null_value) {
  // By the triangle of a QR decomposition: rows are many, columns few.
  const RightSingular svd =
      DecomposeRight(jacobian.rows() >= jacobian.cols() ? Triangle(jacobian) : jacobian);
  SingularDirections directions{svd.values, svd.vectors, 0};
  const Eigen::VectorXd& singular = directions.singular;
  while (directions.rank < singular.size() &&
         singular[directions.rank] > null_value * singular[0]) {
    ++directions.rank;
  }
  return directions;
}

Covariance NaiveCovariance(const ResidualRows& score, const Eigen::VectorXd& unit,
                           double null_value) {
  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  Covariance c;
  c.directions = Decompose(scaled, null_value);
  const int rank = c.directions.rank;
  double sum = 0.0;
  for (int row = 0; row < score.residuals.size(); ++row) {
    if (score.cluster_of_row[row] >= 0) sum += score.residuals[row] * score.residuals[row];
  }
  c.naive_freedom = std::max(1, score.num_data_rows - rank);
  c.sigma = std::sqrt(sum / c.naive_freedom);

  // Rows of data scatter by sigma; priors and demands are in units of their own.
  const Eigen::MatrixXd back = unit.asDiagonal() * c.directions.v.leftCols(rank);
  const Eigen::VectorXd squared = c.directions.singular.head(rank).cwiseAbs2();
  const Eigen::MatrixXd beside = back.transpose() * score.InformationBeside() * back;
  const Eigen::MatrixXd data = Eigen::MatrixXd(squared.asDiagonal()) - beside;
  const Eigen::MatrixXd moves = back * squared.cwiseInverse().asDiagonal();
  c.naive = moves * (c.sigma * c.sigma * data + beside) * moves.transpose();
  return c;
}

Covariance ComputeCovariance(const ResidualRows& score, const Eigen::VectorXd& unit,
                             const Clustering& clustering, double null_value) {
  Covariance c = NaiveCovariance(score, unit, null_value);
  // In the base of the identified directions, then back to the columns as they came.
  const int rank = c.directions.rank;
  const Eigen::MatrixXd back = unit.asDiagonal() * c.directions.v.leftCols(rank);
  const Eigen::VectorXd squared = c.directions.singular.head(rank).cwiseAbs2();
  SplitHessian(score, back, &c);
  Eigen::MatrixXd hessian =
      back.transpose() * (c.by_data + c.by_prior + c.by_settling + c.by_pooling) * back;
  if (score.curvature.size() > 0) {
    const Eigen::MatrixXd full =
        Eigen::MatrixXd(squared.asDiagonal()) + back.transpose() * score.curvature * back;
    c.full_hessian = IsPositiveDefinite(full);
    if (c.full_hessian) {
      hessian = full;
      c.curvature = score.curvature;
    }
  }
  c.inverse_hessian = back * SolveSymmetric(hessian, Eigen::MatrixXd(back.transpose()));
  c.scatter = ClusteredScatter(score, clustering, back, hessian, c.inverse_hessian);
  if (clustering.recordings.count > 1) {
    const Clustering by_recording{
        clustering.recordings, {}, clustering.pooled_units, clustering.priors_scatter};
    c.these = ClusteredScatter(score, by_recording, back, hessian, c.inverse_hessian);
  }
  if (score.clusters.size() < 2) return c;
  c.recordings = score.clusters;
  c.moves = LeftOutMoves(score, c.inverse_hessian);
  return c;
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNormal95 = 1.959963984540054;
constexpr double kMatters = 1e-6;  // of the variance

double QuantileOf(double freedom) {
  return std::isfinite(freedom) ? StudentQuantile95(freedom) : kNormal95;
}

double LeastFreedom(const Eigen::VectorXd& freedom, const Eigen::VectorXd& coefficients) {
  double least = kInfinite;
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0.0) least = std::min(least, freedom[i]);
  }
  return least;
}

}  // namespace

void Scatter::Add(const Eigen::MatrixXd& covariance, double freedom) {
  parts.push_back({covariance, Eigen::VectorXd::Constant(covariance.rows(), freedom)});
}

Eigen::MatrixXd Scatter::Covariance() const {
  Eigen::MatrixXd sum;
  for (const Part& part : parts) {
    sum = sum.size() == 0 ? part.covariance : Eigen::MatrixXd(sum + part.covariance);
  }
  return sum;
}

ScatterOf Scatter::Of(const Eigen::VectorXd& coefficients) const {
  std::vector<double> variances, freedoms;
  double sum = 0.0, squared_width = 0.0;
  for (const Part& part : parts) {
    variances.push_back(std::max(0.0, coefficients.dot(part.covariance * coefficients)));
    freedoms.push_back(LeastFreedom(part.freedom, coefficients));
    const double quantile = QuantileOf(freedoms.back());
    sum += variances.back();
    squared_width += quantile * quantile * variances.back();
  }
  ScatterOf of;
  of.standard_error = std::sqrt(sum);
  of.freedom = parts.empty() ? 1.0 : kInfinite;
  for (size_t k = 0; k < parts.size(); ++k) {
    if (variances[k] >= kMatters * sum) of.freedom = std::min(of.freedom, freedoms[k]);
  }
  of.quantile = sum > 0.0 ? std::sqrt(squared_width / sum) : QuantileOf(of.freedom);
  return of;
}

ScatterOf Scatter::OfColumn(Eigen::Index column) const {
  return Of(Eigen::VectorXd::Unit(parts.empty() ? column + 1 : parts[0].covariance.rows(), column));
}

}  // namespace pushid
