// Decompositions of dense matrices at the edge of their domain.
#include "models/decompositions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace pushid {
namespace {

// 3 e_2: one singular value, along the second axis.
TEST(Decompositions, RightSingularByHand) {
  Eigen::MatrixXd a(1, 2);
  a << 0.0, 3.0;
  const RightSingular of_row = DecomposeRight(a);
  EXPECT_NEAR(of_row.values[0], 3.0, 1e-14);
  EXPECT_NEAR(std::abs(of_row.vectors(1, 0)), 1.0, 1e-14);
}

// Where every rollout fails a Jacobian has no rows: nothing is told of any direction.
TEST(Decompositions, WithoutRowsNothingIsTold) {
  const RightSingular none = DecomposeRight(Eigen::MatrixXd(0, 3));
  EXPECT_EQ(none.values, Eigen::VectorXd::Zero(3));
  EXPECT_EQ(none.vectors, Eigen::MatrixXd::Identity(3, 3));
}

// R of three matrices with the shape of a Jacobian of more rows, of as many and of fewer: A V has
// orthogonal columns as long as the singular values.
TEST(Decompositions, RightSingularOfAnyShape) {
  for (int rows : {7, 4, 2}) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(
        rows, 4, [](int row, int col) { return std::sin(1.0 + 3.0 * row + 2.0 * col * col); });
    const RightSingular of = DecomposeRight(a);
    const Eigen::MatrixXd turned = a * of.vectors;
    const Eigen::MatrixXd squares = of.values.cwiseAbs2().asDiagonal();
    EXPECT_LT((turned.transpose() * turned - squares).norm(), 1e-13) << rows << " rows";
    EXPECT_EQ(Rank(a, 1e-9), (of.values.array() > 1e-9 * of.values[0]).count()) << rows << " rows";
  }
}

// By hand: a quarter turn has eigenvalues i and -i, and beside them stands the axis with 1.
TEST(Decompositions, EigenvaluesOfAQuarterTurn) {
  const Eigen::MatrixXd turn{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  Eigen::VectorXcd values = Eigenvalues(turn);
  std::sort(values.begin(), values.end(), [](auto a, auto b) { return a.imag() < b.imag(); });
  EXPECT_LT(std::abs(values[0] + std::complex<double>(0.0, 1.0)), 1e-14);
  EXPECT_LT(std::abs(values[1] - 1.0), 1e-14);
  EXPECT_LT(std::abs(values[2] - std::complex<double>(0.0, 1.0)), 1e-14);
  EXPECT_NEAR(SpectralRadius(2.0 * turn), 2.0, 1e-14);
}

TEST(Decompositions, TurnsOneDirectionIntoAnother) {
  const Eigen::Vector3d from(1.0, -2.0, 0.5);
  for (const Eigen::Vector3d& to :
       {Eigen::Vector3d(0.3, 0.1, -2.0), from, Eigen::Vector3d(-from)}) {
    const Eigen::Matrix3d turn = TurnBetween(from, to).toRotationMatrix();
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-14) << to.transpose();
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

// Marks that a turn moved turn back, also where they lie in a plane.
TEST(Decompositions, NearestRotationOfATurnedPlane) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  Eigen::Matrix3Xd marks(3, 4);
  marks << 1.0, 0.0, -1.0, 0.5, 0.0, 1.0, 0.3, -1.0, 0.0, 0.0, 0.0, 0.0;
  EXPECT_LT((NearestRotation(turn * marks * marks.transpose()) - turn).norm(), 1e-13);
}

}  // namespace
}  // namespace pushid
