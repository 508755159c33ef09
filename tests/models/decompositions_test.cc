// Decompositions of dense matrices at the edge of their domain.
#include "models/decompositions.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace pushid
