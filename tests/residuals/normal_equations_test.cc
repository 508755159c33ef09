// Rows condensed to as many as columns, with the same J'J, J'r and r'r.
#include "residuals/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "datasets/files/random.h"

namespace pushid {
namespace {

// rows: [J r].
NormalEquations Of(const RowMajorMatrix& rows) {
  const int columns = static_cast<int>(rows.cols()) - 1;
  RowMajorMatrix padded = RowMajorMatrix::Zero(rows.rows(), NormalEquations::PaddedSize(columns));
  padded.leftCols(columns) = rows.leftCols(columns);
  const Eigen::VectorXd residuals = rows.col(columns);
  NormalEquations equations(columns);
  equations.Add(static_cast<int>(rows.rows()), padded.data(), residuals.data());
  return equations;
}

void ExpectSameProducts(const RowMajorMatrix& rows) {
  const RowMajorMatrix factor = Of(rows).Factor();
  const RowMajorMatrix expected = rows.transpose() * rows;
  const RowMajorMatrix products = factor.transpose() * factor;
  ASSERT_EQ(factor.rows(), rows.cols());
  for (Eigen::Index i = 0; i < products.rows(); ++i) {
    for (Eigen::Index j = 0; j < products.cols(); ++j) {
      EXPECT_NEAR(products(i, j), expected(i, j),
                  1e-13 * std::sqrt(expected(i, i) * expected(j, j)) + 1e-300)
          << i << ", " << j;
    }
  }
}

// J = [1 0; 0 2; 0 0], r = [1 4 3]: R is J's own upper part up to order, and 3 is left.
TEST(NormalEquations, WorkedByHand) {
  RowMajorMatrix rows(3, 3);
  rows << 1, 0, 1,  //
      0, 2, 4,      //
      0, 0, 3;
  const RowMajorMatrix factor = Of(rows).Factor();
  EXPECT_DOUBLE_EQ(factor(2, 2), 3.0);
  EXPECT_EQ(factor(2, 0), 0.0);
  EXPECT_EQ(factor(2, 1), 0.0);
  ExpectSameProducts(rows);
}

TEST(NormalEquations, ColumnsOfAnySize) {
  Random random(61);
  for (int columns : {1, 6, 7, 8, 19, 40}) {
    RowMajorMatrix rows(200, columns + 1);
    for (int i = 0; i < rows.size(); ++i) rows.data()[i] = random.Normal();
    for (int c = 0; c < columns; ++c) rows.col(c) *= std::pow(10.0, random.Uniform(-8, 8));
    ExpectSameProducts(rows);
  }
}

// A sum of columns, and a column of zeros: what is left of them is rounding, and says nothing.
TEST(NormalEquations, DependentColumnsMakeRowsOfZeros) {
  Random random(62);
  RowMajorMatrix rows(60, 6);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = random.Normal();
  rows.col(3) = 1e4 * rows.col(0) - 1e4 * rows.col(1);
  rows.col(4).setZero();
  ExpectSameProducts(rows);
  const RowMajorMatrix factor = Of(rows).Factor();
  EXPECT_EQ(factor.row(3).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(factor.row(4).cwiseAbs().maxCoeff(), 0.0);
  Eigen::VectorXd null(5);
  null << 1e4, -1e4, 0.0, -1.0, 0.0;
  EXPECT_LT((factor.leftCols(5) * null).norm(), 1e-11 * factor.col(0).norm() * null.norm());
}

TEST(NormalEquations, FewerRowsThanColumns) {
  Random random(63);
  RowMajorMatrix rows(4, 12);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = random.Normal();
  ExpectSameProducts(rows);
}

// A part of an exact fit: no residual is left, nor may rounding make its root NaN.
TEST(NormalEquations, ExactFitsLeaveNothing) {
  Random random(64);
  RowMajorMatrix rows(50, 4);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = random.Normal();
  rows.col(3) = rows.col(0) + 2.0 * rows.col(1) - rows.col(2);
  const RowMajorMatrix factor = Of(rows).Factor();
  EXPECT_LT(factor(3, 3), 1e-6 * rows.col(3).norm());
  ExpectSameProducts(rows);
}

}  // namespace
}  // namespace pushid
