// siMLPe by hand: two coordinates over two frames, D = [1 1; 1 -1] / sqrt(2).
#include <gtest/gtest.h>

#include <cmath>

#include "models/generators/particle_generator.h"

namespace pushid {
namespace {

// Coefficients go through as they are, beside what the block adds to them.
SimlpeNetwork Through() {
  const DenseLayer same = {Eigen::Matrix2f::Identity(), Eigen::Vector2f::Zero()};
  SimlpeNetwork network = {Eigen::Vector2f::Zero(), Eigen::Vector2f::Ones(), same, same, {}};
  network.blocks.push_back({{Eigen::Matrix2f::Zero(), Eigen::Vector2f::Zero()},
                            Eigen::Vector2f::Ones(),
                            Eigen::Vector2f::Zero()});
  return network;
}

Trajectories Seen() {
  Trajectories seen(2, 3);
  seen << 9.0f, 3.0f, 5.0f,  //
      9.0f, 1.0f, 2.0f;      // the first frame is too old to be seen
  return seen;
}

// The transform and its inverse cancel: what was seen, from the last pose on.
TEST(SimlpeNetworkTest, CoefficientsGoBackToFrames) {
  const Trajectories next = Through().Forecast(Seen(), 2);
  EXPECT_TRUE(next.col(0).isApprox(Eigen::Vector2f(5.0f + 3.0f, 2.0f + 1.0f)));
  EXPECT_TRUE(next.col(1).isApprox(Eigen::Vector2f(5.0f + 5.0f, 2.0f + 2.0f)));
}

// A shift of both coefficients by (1, -1) is a move of the first frame by sqrt(2) (1, -1) alone.
TEST(SimlpeNetworkTest, AShiftMovesEveryCoefficient) {
  SimlpeNetwork network = Through();
  network.blocks[0].shift = Eigen::Vector2f(1.0f, -1.0f);
  const Eigen::MatrixXf moved = network.Forecast(Seen(), 2) - Through().Forecast(Seen(), 2);
  EXPECT_TRUE(moved.col(0).isApprox(std::sqrt(2.0f) * Eigen::Vector2f(1.0f, -1.0f)));
  EXPECT_LT(moved.col(1).norm(), 1e-5f);
}

// A pose (3, 1) that is held has the coefficients sqrt(2) (3, 1) and 0, which the norm makes
// (1, -1) and 0: every frame moves by (1, -1) / sqrt(2).
TEST(SimlpeNetworkTest, TheNormIsOverCoordinates) {
  SimlpeNetwork network = Through();
  network.blocks[0].mix.weights.setIdentity();
  const Trajectories held = Eigen::Vector2f(3.0f, 1.0f).replicate(1, 2);
  const Trajectories next = network.Forecast(held, 2);
  for (int t = 0; t < 2; ++t) {
    const Eigen::Vector2f expected(6.0f + std::sqrt(0.5f), 2.0f - std::sqrt(0.5f));
    EXPECT_LT((next.col(t) - expected).norm(), 1e-4f) << t;
  }
}

// Spreads of poses, and a longer forecast, which continues the first two frames of itself.
TEST(SimlpeNetworkTest, LongerForecastsContinueTheirOwn) {
  SimlpeNetwork network = Through();
  network.pose_mean = Eigen::Vector2f(7.0f, 7.0f);
  network.pose_spread = Eigen::Vector2f(1.0f, 10.0f);
  network.output.weights.setZero();
  network.output.bias = Eigen::Vector2f(0.1f, 0.1f);  // of both coefficients: the first frame moves
  const Trajectories next = network.Forecast(Seen(), 3);
  const Eigen::Vector2f last(5.0f, 2.0f), moved(0.1f * std::sqrt(2.0f), std::sqrt(2.0f));
  EXPECT_TRUE(next.col(0).isApprox(last + moved));
  EXPECT_TRUE(next.col(1).isApprox(last));
  EXPECT_TRUE(next.col(2).isApprox(last + moved));
}

}  // namespace
}  // namespace pushid
