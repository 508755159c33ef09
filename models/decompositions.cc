// models: decompositions of dense matrices, by Eigen.
#include "models/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace pushid {

Eigen::MatrixXd SymmetricEigen::InverseSqrt() const {
  const Eigen::MatrixXd scaled = vectors * values.cwiseInverse().cwiseSqrt().asDiagonal();
  return scaled * vectors.transpose();
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
  return SolveSymmetric(a, Eigen::MatrixXd(b));
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

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a) {
  return SolveGeneral(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

Eigen::MatrixXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::VectorXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return SolveLeastNorm(a, Eigen::MatrixXd(b));
}

Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& a) {
  return SolveLeastNorm(a, Eigen::MatrixXd(Eigen::MatrixXd::Identity(a.rows(), a.rows())));
}

int Rank(const Eigen::MatrixXd& a, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr;
  qr.setThreshold(threshold);
  return static_cast<int>(qr.compute(a).rank());
}

Eigen::MatrixXd Triangle(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

// Takes a square matrix with the same values and vectors: without the QR decompositions inside
// Eigen's own it compiles in a fraction of the time.
RightSingular DecomposeRight(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(a.cols(), a.cols());
  if (a.rows() > a.cols()) {
    square = Triangle(a);
  } else {
    square.topRows(a.rows()) = a;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(square,
                                                                         Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& a) {
  const Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> svd(
      a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU(), v = svd.matrixV();
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((u * v.transpose()).determinant() < 0.0) sign.z() = -1.0;
  return u * sign.asDiagonal() * v.transpose();
}

// Eigen's FromTwoVectors decomposes a 2 x 3 matrix for opposite directions, which takes the
// compiler longer than any other decomposition here.
Eigen::Quaterniond TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  if (cosine < -1.0 + Eigen::NumTraits<double>::dummy_precision()) {
    const Eigen::Vector3d axis = a.unitOrthogonal();  // opposite: any axis beside them will do
    return Eigen::Quaterniond(0.0, axis.x(), axis.y(), axis.z());
  }
  const double twice_w = std::sqrt(2.0 * (1.0 + cosine));
  const Eigen::Vector3d axis = a.cross(b) / twice_w;
  return Eigen::Quaterniond(0.5 * twice_w, axis.x(), axis.y(), axis.z());
}

}  // namespace pushid
