// ident: covariance on the identified subspace, by singular values of the scaled Jacobian.
#include "ident/covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pushid {
namespace {

// In the coordinates of `jacobian`'s columns: an orthonormal base of the identified subspace.
Eigen::MatrixXd LeaveOneOutMoves(const ScoreBlocks& score, const Eigen::MatrixXd& jacobian) {
  const int groups = static_cast<int>(score.clusters.size());
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  Eigen::MatrixXd moves(jacobian.cols(), groups);
  for (int g = 0; g < groups; ++g) {
    std::vector<int> rows;
    for (int row = 0; row < static_cast<int>(score.cluster_of_row.size()); ++row) {
      if (score.cluster_of_row[row] == score.clusters[g]) rows.push_back(row);
    }
    const Eigen::MatrixXd own = jacobian(rows, Eigen::all);
    const Eigen::VectorXd gradient = own.transpose() * score.residuals(rows);
    const Eigen::MatrixXd rest = hessian - own.transpose() * own;
    // A cluster without which something is undetermined keeps its full leverage.
    const Eigen::LDLT<Eigen::MatrixXd> without(rest);
    const bool determined = without.isPositive() && without.rcond() > 1e-12;
    moves.col(g) = determined ? Eigen::VectorXd(without.solve(gradient))
                              : Eigen::VectorXd(hessian.ldlt().solve(gradient));
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

Covariance ComputeCovariance(const ScoreBlocks& score, const Eigen::VectorXd& unit,
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
  const Eigen::VectorXd inverse = c.directions.singular.head(rank).cwiseInverse();
  c.inverse_hessian = back * inverse.cwiseAbs2().asDiagonal() * back.transpose();
  c.naive = c.sigma * c.sigma * c.inverse_hessian;
  const double groups = static_cast<double>(score.clusters.size());
  if (groups < 2) return c;
  c.clusters = score.clusters;
  c.moves = back * LeaveOneOutMoves(score, scaled * base);
  const Eigen::MatrixXd centred = c.moves.colwise() - c.moves.rowwise().mean().eval();
  c.clustered = (groups - 1.0) / groups * centred * centred.transpose();
  return c;
}

}  // namespace pushid
