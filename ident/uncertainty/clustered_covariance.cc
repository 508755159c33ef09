// ident: CR2 and Satterthwaite's degrees of freedom.
#include "ident/uncertainty/clustered_covariance.h"

#include <Eigen/Dense>
#include <algorithm>

namespace pushid {
namespace {

constexpr double kLeastKept = 0.01;

Eigen::MatrixXd Centred(const Eigen::MatrixXd& columns) {
  return columns.colwise() - columns.rowwise().mean().eval();
}

// What leaving a cluster out would leave of a direction, by the eigenvalues of M_g. A direction
// that one cluster alone determines is counted as ten times what its score says, no more: with
// second derivatives in H leverages may pass one.
Eigen::ArrayXd Kept(const Eigen::ArrayXd& leverage) { return (1.0 - leverage).max(kLeastKept); }

// J'J, most columns of which are zero where units have columns of their own.
Eigen::MatrixXd Information(const Eigen::MatrixXd& jacobian) {
  std::vector<Eigen::Index> used;
  for (Eigen::Index column = 0; column < jacobian.cols(); ++column) {
    if (!jacobian.col(column).isZero(0.0)) used.push_back(column);
  }
  const Eigen::MatrixXd packed = jacobian(Eigen::all, used);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  information(used, used) = packed.transpose() * packed;
  return information;
}

}  // namespace

RowClusters ClusterByRecording(const JacobianBlocks& score) {
  RowClusters clusters;
  for (int cluster : score.cluster_of_row) {
    clusters.of_row.push_back(std::max(-1, cluster));
    clusters.count = std::max(clusters.count, cluster + 1);
  }
  return clusters;
}

ClusterScores GatherScores(const JacobianBlocks& score, const RowClusters& clusters,
                           const Eigen::MatrixXd& base) {
  std::vector<std::vector<int>> rows(clusters.count);
  for (int row = 0; row < static_cast<int>(clusters.of_row.size()); ++row) {
    if (clusters.of_row[row] >= 0) rows[clusters.of_row[row]].push_back(row);
  }
  ClusterScores gathered;
  gathered.scores.resize(base.cols(), 0);
  for (const std::vector<int>& of_cluster : rows) {
    if (of_cluster.empty()) continue;
    const bool robust = score.robust_jacobian.size() > 0;
    const Eigen::MatrixXd own =
        (robust ? score.robust_jacobian : score.jacobian)(of_cluster, Eigen::all);
    gathered.information.push_back(base.transpose() * Information(own) * base);
    gathered.scores.conservativeResize(Eigen::NoChange, gathered.scores.cols() + 1);
    gathered.scores.rightCols(1) =
        base.transpose() *
        (score.jacobian(of_cluster, Eigen::all).transpose() * score.residuals(of_cluster));
  }
  return gathered;
}

ClusteredCovariance Cr2(const ClusterScores& scores, const Eigen::MatrixXd& hessian,
                        const Eigen::MatrixXd& coefficients) {
  const Eigen::MatrixXd root =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).operatorInverseSqrt();
  const Eigen::MatrixXd b = root * coefficients.transpose();  // H^-1/2 c
  const Eigen::Index groups = scores.scores.cols(), size = b.cols();
  Eigen::MatrixXd moves(hessian.rows(), groups);
  Eigen::MatrixXd own(size, groups);  // |p_g|^2
  std::vector<Eigen::MatrixXd> u;     // J_g' p_g over H^1/2, a column a coefficient
  for (Eigen::Index g = 0; g < groups; ++g) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> leverage(
        root * scores.information[static_cast<size_t>(g)] * root);
    const Eigen::MatrixXd& v = leverage.eigenvectors();
    const Eigen::ArrayXd m = leverage.eigenvalues().array().max(0.0), kept = Kept(m);
    moves.col(g) =
        root * v * ((v.transpose() * root * scores.scores.col(g)).array() / kept.sqrt()).matrix();
    const Eigen::MatrixXd along = v.transpose() * b;
    own.col(g) = along.cwiseAbs2().transpose() * (m / kept).matrix();
    u.push_back((m / kept.sqrt()).matrix().asDiagonal() * along);
    u.back() = v * u.back();
  }
  ClusteredCovariance result;
  const Eigen::MatrixXd centred = Centred(moves);
  result.covariance = centred * centred.transpose();
  result.freedom.resize(size);
  for (Eigen::Index c = 0; c < size; ++c) {
    Eigen::MatrixXd at(hessian.rows(), groups);
    for (Eigen::Index g = 0; g < groups; ++g) at.col(g) = u[static_cast<size_t>(g)].col(c);
    Eigen::MatrixXd w = -at.transpose() * at;
    w.diagonal() += own.row(c).transpose();
    const double squares = w.squaredNorm();
    result.freedom[c] = squares > 0.0 ? std::max(1.0, w.trace() * w.trace() / squares) : 1.0;
  }
  return result;
}

}  // namespace pushid
