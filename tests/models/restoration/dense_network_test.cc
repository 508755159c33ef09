// models: products of single precision.
#include "models/restoration/dense_network.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

TEST(FloatProduct, ByHand) {
  Eigen::MatrixXf a(2, 2), b(2, 7);
  a << 1.0f, 2.0f, 3.0f, 4.0f;
  b << 1, 0, 2, 0, 0, 0, 1, 0, 1, 3, 0, 0, 0, 1;
  Eigen::MatrixXf wanted(2, 7);
  wanted << 1, 2, 8, 0, 0, 0, 3, 3, 4, 18, 0, 0, 0, 7;
  EXPECT_EQ(FloatProduct(a, b), wanted);
}

// Tiles that are full, and such that are not, against sums in double precision.
TEST(FloatProduct, EverySize) {
  std::srand(1);
  for (const int rows : {1, 15, 16, 66}) {
    for (const int depth : {1, 3, 411}) {
      for (const int columns : {1, 5, 6, 7, 100}) {
        const Eigen::MatrixXf a = Eigen::MatrixXf::Random(rows, depth);
        const Eigen::MatrixXf b = Eigen::MatrixXf::Random(depth, columns);
        const Eigen::MatrixXd wanted = a.cast<double>() * b.cast<double>();
        const double off = (FloatProduct(a, b).cast<double>() - wanted).cwiseAbs().maxCoeff();
        EXPECT_LT(off, 1e-6 * depth) << rows << " " << depth << " " << columns;
      }
    }
  }
}

}  // namespace
}  // namespace pushid
