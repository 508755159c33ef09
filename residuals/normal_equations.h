// residuals: the normal equations of some rows, and the fewest rows that have the same.
//
// A least-squares solver asks many rows [J r] for nothing but J'J, J'r and r'r. All three are in
//   G = [J r]'[J r]
// whose parts grow by a few rows at a time while they are still in the cache, and
//   F = [R z; 0 rho] with F'F = G
// has as many rows as columns. R is the Cholesky factor of J'J with its columns scaled to length
// one, the column of which most is left next. A column of which less than kNoInformation is left
// once the others are known is rounding: the factor ends, and with it what would be noise over
// noise. Rejected: Eigen's LDLT, whose pivots do not see what is left and so tell no rank; a QR
// decomposition of all rows, which knows directions a millionth as long and takes ten times the
// work; r as a last column of J, with which sixteen columns take three vectors of eight. Nothing
// below kNullSingularValue (ident/uncertainty/covariance.h) is called identified.
#pragma once

#include <Eigen/Core>

namespace pushid {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class NormalEquations {
 public:
  NormalEquations() = default;
  explicit NormalEquations(int columns);
  // G's upper triangle by rows, its numbers `stride` apart.
  NormalEquations(int columns, const double* upper, int stride);

  // Doubles in a row of J that Add takes: its columns, then zeros.
  static int PaddedSize(int columns);

  // rows: `count` of PaddedSize(columns); residuals: as many.
  void Add(int count, const double* rows, const double* residuals);
  void Add(const NormalEquations& other);

  int columns() const { return columns_; }
  // J'J on and above its diagonal, and J'r; padded.
  const RowMajorMatrix& information() const { return information_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  // F: columns + 1 rows, the last of which is [0 rho].
  RowMajorMatrix Factor() const;

 private:
  int columns_ = 0;
  double squares_ = 0.0;        // r'r
  Eigen::VectorXd gradient_;    // J'r, padded as information_
  RowMajorMatrix information_;  // J'J, padded; left of the diagonal's blocks nothing
};

}  // namespace pushid
