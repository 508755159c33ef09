// Products and activations by vectors: against Eigen and the standard library, for every width that
// this processor has.
#include "residuals/packed/packed_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "datasets/files/random.h"

namespace pushid {
namespace {

Eigen::MatrixXd RandomMatrix(int rows, int columns, Random* random) {
  Eigen::MatrixXd matrix(rows, columns);
  for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = random->Uniform(-1.0, 1.0);
  return matrix;
}

TEST(PackedMatrix, ProductsEqualEigens) {
  Random random(71);
  for (const VectorKernels* kernels : SupportedVectorKernels()) {
    for (int rows : {1, 7, 24, 61}) {
      for (int columns : {1, 4, 8, 29}) {
        for (int depth : {1, 5, 320, 321, 700}) {
          const Eigen::MatrixXd a = RandomMatrix(rows, depth, &random);
          const Eigen::MatrixXd b = RandomMatrix(depth, columns, &random);
          Eigen::MatrixXd c = RandomMatrix(rows, columns, &random);
          const Eigen::MatrixXd expected = c + a * b;
          PackedMatrix left(*kernels, PackedMatrix::kLeft), right(*kernels, PackedMatrix::kRight);
          left.Pack(a.data(), rows, depth, 1, rows);
          right.Pack(b.data(), columns, depth, depth, 1);
          AddProduct(left, right, c.data(), rows);
          EXPECT_LE((c - expected).cwiseAbs().maxCoeff(), 1e-13 * std::sqrt(depth))
              << kernels->name << ", " << rows << " x " << depth << " x " << columns;
        }
      }
    }
  }
}

// Of rows of a wider matrix; left of the diagonal's blocks nothing may change.
TEST(Gram, EqualsEigens) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Random random(75);
  for (const VectorKernels* kernels : SupportedVectorKernels()) {
    for (int rows : {1, 9, 40}) {
      for (int columns : {8, 16, 40}) {
        const Rows a = RandomMatrix(rows, columns + 3, &random);
        const Rows before = RandomMatrix(columns, columns + 1, &random);
        Rows g = before;
        kernels->add_gram(rows, columns, a.data(), columns + 3, g.data(), columns + 1);
        const Eigen::VectorXd factors = RandomMatrix(rows, 1, &random);
        Eigen::VectorXd added = before.row(0).head(columns);
        const Eigen::VectorXd by_rows = added + a.leftCols(columns).transpose() * factors;
        kernels->add_rows(rows, columns, factors.data(), a.data(), columns + 3, added.data());
        EXPECT_LE((added - by_rows).cwiseAbs().maxCoeff(), 1e-13) << kernels->name;
        const Rows sum =
            before.leftCols(columns) + a.leftCols(columns).transpose() * a.leftCols(columns);
        for (int i = 0; i < columns; ++i) {
          for (int j = 0; j < columns; ++j) {
            const double expected = j / kGramBlock < i / kGramBlock ? before(i, j) : sum(i, j);
            EXPECT_NEAR(g(i, j), expected, 1e-13) << kernels->name << ", " << i << ", " << j;
          }
        }
      }
    }
  }
}

// A column of a product does not depend on who stands beside it.
TEST(PackedMatrix, ColumnsKnowNothingOfEachOther) {
  Random random(72);
  for (const VectorKernels* kernels : SupportedVectorKernels()) {
    const Eigen::MatrixXd a = RandomMatrix(30, 50, &random), b = RandomMatrix(50, 11, &random);
    PackedMatrix left(*kernels, PackedMatrix::kLeft), right(*kernels, PackedMatrix::kRight);
    left.Pack(a.data(), 30, 50, 1, 30);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(30, 11);
    right.Pack(b.data(), 11, 50, 50, 1);
    AddProduct(left, right, all.data(), 30);
    for (int n = 0; n < 11; ++n) {
      Eigen::VectorXd one = Eigen::VectorXd::Zero(30);
      right.Pack(b.col(n).data(), 1, 50, 50, 1);
      AddProduct(left, right, one.data(), 30);
      EXPECT_EQ(one, all.col(n)) << kernels->name;
    }
  }
}

double UnitsApart(double actual, double expected) {
  return std::abs(actual - expected) /
         (std::numeric_limits<double>::epsilon() * std::max(std::abs(expected), 1e-300));
}

TEST(VectorKernels, ActivationsAreExactToAFewUnits) {
  Random random(73);
  std::vector<double> x = {0.0, 1e-300, 1e-16, -1e-8, 0.34, 0.35, -0.35, 1.04, 19.0, -19.0, 36.0};
  for (int i = 0; i < 2000; ++i)
    x.push_back(random.Normal() * std::pow(10.0, random.Uniform(-9, 1)));
  for (const VectorKernels* kernels : SupportedVectorKernels()) {
    std::vector<double> tanh = x, logistic = x;
    kernels->tanh(tanh.data(), static_cast<std::ptrdiff_t>(x.size()));
    kernels->logistic(logistic.data(), static_cast<std::ptrdiff_t>(x.size()));
    for (size_t i = 0; i < x.size(); ++i) {
      EXPECT_LE(UnitsApart(tanh[i], std::tanh(x[i])), 4.0) << kernels->name << ", " << x[i];
      EXPECT_LE(UnitsApart(logistic[i], 1.0 / (1.0 + std::exp(-x[i]))), 4.0)
          << kernels->name << ", " << x[i];
    }
  }
}

TEST(VectorKernels, ActivationsAtTheEdges) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const VectorKernels* kernels : SupportedVectorKernels()) {
    std::vector<double> tanh = {infinity, -infinity, 1e300, NAN, 0.0}, logistic = tanh;
    kernels->tanh(tanh.data(), 5);
    kernels->logistic(logistic.data(), 5);
    EXPECT_EQ(tanh[0], 1.0);
    EXPECT_EQ(tanh[1], -1.0);
    EXPECT_EQ(tanh[2], 1.0);
    EXPECT_TRUE(std::isnan(tanh[3]));
    EXPECT_EQ(tanh[4], 0.0);
    EXPECT_EQ(logistic[0], 1.0);
    EXPECT_LE(logistic[1], 1e-300);
    EXPECT_TRUE(std::isnan(logistic[3]));
    EXPECT_EQ(logistic[4], 0.5);
  }
}

}  // namespace
}  // namespace pushid
