// ident: covariance on the identified subspace, by singular values of the scaled Jacobian.
#include "ident/uncertainty/covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pushid {
namespace {

constexpr double kDetermined = 1e-9;  // share of a direction's information that is left

bool IsMinimum(const Eigen::LDLT<Eigen::MatrixXd>& hessian) {
  return hessian.isPositive() && hessian.rcond() > 1e-12;
}

// In the coordinates of `back`'s columns (a base of the identified subspace), with their Hessian H:
// H^-1/2 (1 - M)^-1/2 H^-1/2 s_g for each cluster, M = H^-1/2 J_g'J_g H^-1/2.
Eigen::MatrixXd UnbiasedMoves(const JacobianBlocks& score, const Eigen::MatrixXd& back,
                              const Eigen::MatrixXd& hessian) {
  const Eigen::MatrixXd root =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).operatorInverseSqrt();
  Eigen::MatrixXd moves(back.cols(), score.clusters.size());
  for (size_t g = 0; g < score.clusters.size(); ++g) {
    const std::vector<int> rows = score.RowsOf(score.clusters[g]);
    const Eigen::MatrixXd own = score.jacobian(rows, Eigen::all) * back * root;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> leverage(own.transpose() * own);
    const Eigen::MatrixXd& v = leverage.eigenvectors();
    const Eigen::ArrayXd rest = 1.0 - leverage.eigenvalues().array();
    // A direction that is undetermined without the cluster keeps the cluster's full leverage.
    const Eigen::ArrayXd kept = (rest > kDetermined).select(rest, 1.0);
    const Eigen::VectorXd gradient = v.transpose() * (own.transpose() * score.residuals(rows));
    moves.col(g) = root * v * (gradient.array() / kept.sqrt()).matrix();
  }
  return moves;
}

// H^-1 s_g G / (G - 1) for each cluster.
Eigen::MatrixXd LeftOutMoves(const JacobianBlocks& score, const Eigen::MatrixXd& inverse_hessian) {
  const double groups = static_cast<double>(score.clusters.size());
  Eigen::MatrixXd moves(inverse_hessian.cols(), score.clusters.size());
  for (size_t g = 0; g < score.clusters.size(); ++g) {
    const std::vector<int> rows = score.RowsOf(score.clusters[g]);
    const Eigen::VectorXd gradient =
        score.jacobian(rows, Eigen::all).transpose() * score.residuals(rows);
    moves.col(g) = groups / (groups - 1.0) * inverse_hessian * gradient;
  }
  return moves;
}

}  // namespace

double Directions::Condition() const {
  return rank > 0 ? singular[0] / singular[rank - 1] : std::numeric_limits<double>::infinity();
}

Directions Decompose(const Eigen::MatrixXd& jacobian, double null_value) {
  // By the triangle of a QR decomposition: rows are many, columns few.
  const Eigen::Index size = jacobian.cols();
  Eigen::MatrixXd triangle = jacobian;
  if (jacobian.rows() >= size) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(jacobian);
    triangle = qr.matrixQR().topRows(size).triangularView<Eigen::Upper>();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangle, Eigen::ComputeFullV);
  Directions directions{svd.singularValues(), svd.matrixV(), 0};
  const Eigen::VectorXd& singular = directions.singular;
  while (directions.rank < singular.size() &&
         singular[directions.rank] > null_value * singular[0]) {
    ++directions.rank;
  }
  return directions;
}

Covariance ComputeCovariance(const JacobianBlocks& score, const Eigen::VectorXd& unit,
                             double null_value) {
  const Eigen::MatrixXd scaled = score.jacobian * unit.asDiagonal();
  Covariance c;
  c.directions = Decompose(scaled, null_value);
  const int rank = c.directions.rank;
  double sum = 0.0;
  for (int row = 0; row < score.residuals.size(); ++row) {
    if (score.cluster_of_row[row] >= 0) sum += score.residuals[row] * score.residuals[row];
  }
  c.freedom = std::max(1, score.num_data_rows - rank);
  c.sigma = std::sqrt(sum / c.freedom);

  // In the base of the identified directions, then back to the columns as they came.
  const Eigen::MatrixXd base = c.directions.v.leftCols(rank);
  const Eigen::MatrixXd back = unit.asDiagonal() * base;
  const Eigen::VectorXd squared = c.directions.singular.head(rank).cwiseAbs2();
  c.naive = c.sigma * c.sigma * back * squared.cwiseInverse().asDiagonal() * back.transpose();

  Eigen::MatrixXd hessian = squared.asDiagonal();
  if (score.curvature.size() > 0) {
    const Eigen::MatrixXd full = hessian + back.transpose() * score.curvature * back;
    c.full_hessian = IsMinimum(Eigen::LDLT<Eigen::MatrixXd>(full));
    if (c.full_hessian) hessian = full;
  }
  c.inverse_hessian = back * hessian.ldlt().solve(back.transpose());
  if (score.clusters.size() < 2) return c;
  c.clusters = score.clusters;
  c.moves = LeftOutMoves(score, c.inverse_hessian);
  const Eigen::MatrixXd unbiased = back * UnbiasedMoves(score, back, hessian);
  const Eigen::MatrixXd centred = unbiased.colwise() - unbiased.rowwise().mean().eval();
  c.clustered = centred * centred.transpose();
  return c;
}

}  // namespace pushid
