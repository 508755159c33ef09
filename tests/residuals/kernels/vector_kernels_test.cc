// Sums of products by vectors against Eigen's, for every width that this processor has.
#include "residuals/kernels/vector_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "datasets/files/random.h"

namespace pushid {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd RandomMatrix(int rows, int columns, Random* random) {
  Eigen::MatrixXd matrix(rows, columns);
  for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = random->Uniform(-1.0, 1.0);
  return matrix;
}

// By columns and by rows, of sides that are parts of wider matrices.
TEST(VectorKernels, ProductsEqualEigens) {
  Random random(71);
  for (const VectorKernels* kernels : Supported<VectorKernels>()) {
    for (int rows : {1, 7, 24, 61}) {
      for (int columns : {1, 4, 8, 29}) {
        for (int depth : {1, 5, 320, 321, 700}) {
          const Eigen::MatrixXd a = RandomMatrix(rows + 3, depth, &random);
          const Eigen::MatrixXd b = RandomMatrix(depth + 2, columns, &random);
          const RowMajor a_by_rows = a, b_by_rows = b;
          const Eigen::MatrixXd before = RandomMatrix(rows + 1, columns, &random);
          const Eigen::MatrixXd expected =
              before.topRows(rows) + a.topRows(rows) * b.topRows(depth);
          for (bool left : {false, true}) {
            for (bool right : {false, true}) {
              Eigen::MatrixXd sum = before;
              kernels->add_product(
                  {left ? a_by_rows.data() : a.data(), rows, depth, left ? depth : rows + 3, left},
                  {right ? b_by_rows.data() : b.data(), depth, columns, right ? columns : depth + 2,
                   right},
                  sum.data(), rows + 1);
              EXPECT_LE((sum.topRows(rows) - expected).cwiseAbs().maxCoeff(),
                        1e-13 * std::sqrt(depth))
                  << kernels->bits << ", " << rows << " x " << depth << " x " << columns;
              EXPECT_EQ(sum.row(rows), before.row(rows));
            }
          }
        }
      }
    }
  }
}

// Gram matrices of rows of a wider matrix; left of the diagonal's blocks nothing may change.
TEST(Gram, EqualsEigens) {
  Random random(75);
  for (const VectorKernels* kernels : Supported<VectorKernels>()) {
    for (int rows : {1, 9, 40}) {
      for (int columns : {8, 16, 40}) {
        const RowMajor a = RandomMatrix(rows, columns + 3, &random);
        const RowMajor before = RandomMatrix(columns, columns + 1, &random);
        RowMajor g = before;
        kernels->add_gram(rows, columns, a.data(), columns + 3, g.data(), columns + 1);
        const Eigen::VectorXd factors = RandomMatrix(rows, 1, &random);
        Eigen::VectorXd added = before.row(0).head(columns);
        const Eigen::VectorXd by_rows = added + a.leftCols(columns).transpose() * factors;
        kernels->add_rows(rows, columns, factors.data(), a.data(), columns + 3, added.data());
        EXPECT_LE((added - by_rows).cwiseAbs().maxCoeff(), 1e-13) << kernels->bits;
        const RowMajor sum =
            before.leftCols(columns) + a.leftCols(columns).transpose() * a.leftCols(columns);
        for (int i = 0; i < columns; ++i) {
          for (int j = 0; j < columns; ++j) {
            const double expected = j / kGramBlock < i / kGramBlock ? before(i, j) : sum(i, j);
            EXPECT_NEAR(g(i, j), expected, 1e-13) << kernels->bits << ", " << i << ", " << j;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace pushid
