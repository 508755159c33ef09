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

Eigen::VectorXcd Eigenvalues(const Eigen::MatrixXd& a) { return a.eigenvalues(); }

double SpectralRadius(const Eigen::MatrixXd& a) { return Eigenvalues(a).cwiseAbs().maxCoeff(); }

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

Eigen::MatrixXd CholeskyFactor(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  if (factor.info() != Eigen::Success) return {};
  return factor.matrixL();
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

Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU(), v = svd.matrixV();
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((u * v.transpose()).determinant() < 0.0) sign.z() = -1.0;
  return u * sign.asDiagonal() * v.transpose();
}

Eigen::Quaterniond TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace pushid
