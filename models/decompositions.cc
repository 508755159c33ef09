// models: decompositions of dense matrices, by Eigen.
#include "models/decompositions.h"

#include <Eigen/Dense>

namespace pushid {

Eigen::MatrixXd SymmetricEigen::InverseSqrt() const {
  return vectors * values.cwiseInverse().cwiseSqrt().asDiagonal() * vectors.transpose();
}

SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double SpectralRadius(const Eigen::MatrixXd& a) { return a.eigenvalues().cwiseAbs().maxCoeff(); }

Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}

Eigen::VectorXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.ldlt().solve(b);
}

Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> SolveSymmetricTransposed(
    const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b.transpose());
}

bool IsPositiveDefinite(const Eigen::MatrixXd& a) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(a);
  return factor.isPositive() && factor.rcond() > 1e-12;
}

Eigen::MatrixXd SolveGeneral(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

Eigen::MatrixXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::VectorXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

int Rank(const Eigen::MatrixXd& a, double threshold) {
  Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
  lu.setThreshold(threshold);
  return static_cast<int>(lu.rank());
}

Eigen::MatrixXd Triangle(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

RightSingular DecomposeRight(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) {
    return {Eigen::VectorXd::Zero(a.cols()), Eigen::MatrixXd::Identity(a.cols(), a.cols())};
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace pushid
