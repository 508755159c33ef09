// models: decompositions of dense matrices, compiled in one place. Eigen's templates of them take
// the compiler seconds in every source that uses one.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pushid {

// Eigenvalues of a symmetric matrix, whose lower triangle is read; they ascend.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // a column each

  Eigen::MatrixXd InverseSqrt() const;  // A^-1/2
};
SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& a);

// Eigenvalues of any square matrix.
Eigen::VectorXcd Eigenvalues(const Eigen::MatrixXd& a);
// The largest absolute one.
double SpectralRadius(const Eigen::MatrixXd& a);

// A^-1 b of a symmetric semi-definite A, by LDLT.
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd SolveSymmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
// Whether A is positive definite, beyond what rounding may hide.
bool IsPositiveDefinite(const Eigen::MatrixXd& a);

// L of A = L L', a symmetric one of which the lower triangle is read; empty where A is not positive
// definite.
Eigen::MatrixXd CholeskyFactor(const Eigen::MatrixXd& a);

// A^-1 b of any regular A, by LU.
Eigen::MatrixXd SolveGeneral(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a);

// The shortest x with the least |A x - b|, by a complete orthogonal decomposition.
Eigen::MatrixXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd SolveLeastNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& a);

// The rank by a QR decomposition with pivoting, where pivots below `threshold` of the largest count
// as zero.
int Rank(const Eigen::MatrixXd& a, double threshold);

// R of A = Q R, for at least as many rows as columns.
Eigen::MatrixXd Triangle(const Eigen::MatrixXd& a);

// Singular values, which descend, and the right singular vectors, a column each.
struct RightSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
RightSingular DecomposeRight(const Eigen::MatrixXd& a);

// The rotation R for which the trace of R' A is largest: with A the sum of to from' it turns `from`
// to `to` with the least squares (Kabsch 1976).
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& a);

// The shortest turn of one direction into another; about some axis beside them where they are
// opposite.
Eigen::Quaterniond TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace pushid
