// The window's joints with derivatives: positions are the restoration's, derivatives those of
// finite differences, wherever a person stands and faces.
#include <gtest/gtest.h>

#include "models/restoration/body_tangent.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

constexpr int kFrames = 40;
const std::vector<int> kAsked = {1, 5, 20, 38, 39};

// q moved along the columns of its derivatives by `steps`.
RestorationInput Moved(RestorationInput person, const WindowTangent::PathDerivatives& derivatives,
                       const Eigen::VectorXd& steps) {
  for (int t = 0; t < kFrames; ++t) {
    const Eigen::VectorXd move = derivatives[t] * steps;
    person.q[t] += move.head<4>();
    person.lengths[t] += move.tail<2>();
  }
  return person;
}

// Smooth in time and nothing at frame 0, as sensitivities are.
WindowTangent::PathDerivatives Derivatives(int columns, uint64_t seed) {
  Random random(seed);
  WindowTangent::PathDerivatives derivatives;
  const Eigen::MatrixXf a = RandomMatrix(BodyTangent::kPathRows, columns, 1.0, &random);
  const Eigen::MatrixXf b = RandomMatrix(BodyTangent::kPathRows, columns, 1.0, &random);
  for (int t = 0; t < kFrames; ++t) {
    const double s = t / 60.0;
    derivatives.emplace_back((s * s * a + s * std::sin(5.0 * s) * b).cast<double>());
  }
  return derivatives;
}

TEST(WindowTangentTest, PositionsAreTheRestorations) {
  const WindowWeights weights = RandomWindow(3);
  const RestorationInput person =
      MovingPerson(Placed(StandingPose(), 0.8, {0.3, -0.6, 0.0}), 70.0, kFrames);
  const BodyMotion motion = WindowRestoration(weights).Restore({person})[0];
  const auto joints = WindowTangent(weights).At(person, {}, kAsked);
  for (size_t k = 0; k < kAsked.size(); ++k) {
    EXPECT_EQ(joints[k].derivatives.cols(), 0);
    const Eigen::VectorXd expected = motion[kAsked[k]].reshaped();
    EXPECT_LT((joints[k].positions - expected).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(WindowTangentTest, DerivativesAreThoseOfFiniteDifferences) {
  constexpr int kColumns = 3;
  constexpr double kStep = 1e-5;
  const WindowTangent tangent(RandomWindow(4));
  const auto derivatives = Derivatives(kColumns, 5);
  for (const double turn : {0.0, 0.8, -2.5}) {
    for (const double fps : {60.0, 25.0}) {
      RestorationInput person =
          MovingPerson(Placed(StandingPose(), turn, {0.3, -0.6, 0.0}), 70.0, kFrames);
      person.dt = 1.0 / fps;  // lags between frames
      for (int t = 0; t < kFrames; ++t) {
        person.lengths.emplace_back(person.body.rod_length - 1e-3 * t,
                                    person.body.cart_height + 5e-4 * t);
      }
      const auto joints = tangent.At(person, derivatives, kAsked);
      for (int column = 0; column < kColumns; ++column) {
        const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(kColumns, column);
        const auto above = tangent.At(Moved(person, derivatives, step), {}, kAsked);
        const auto below = tangent.At(Moved(person, derivatives, -step), {}, kAsked);
        for (size_t k = 0; k < kAsked.size(); ++k) {
          const Eigen::VectorXd expected =
              (above[k].positions - below[k].positions) / (2.0 * kStep);
          const double largest = expected.cwiseAbs().maxCoeff();
          EXPECT_LT((joints[k].derivatives.col(column) - expected).cwiseAbs().maxCoeff(),
                    1e-6 * (1.0 + largest))
              << "turned by " << turn << ", frame " << kAsked[k] << ", column " << column;
        }
      }
    }
  }
}

TEST(WindowTangentTest, WhatLiesBeyondTheScalingHasNoDerivative) {
  WindowWeights weights = RandomWindow(6);
  weights.inputs.mean.head(kWindowRodInput + 1).setConstant(100.0f);
  const RestorationInput person = MovingPerson(StandingPose(), 70.0, kFrames);
  const auto derivatives = Derivatives(1, 7);
  const auto joints = WindowTangent(weights).At(person, derivatives, {20});
  // All joints go with the rod's tip alone.
  for (int j = 1; j < kBodyJoints; ++j) {
    EXPECT_EQ(joints[0].derivatives.middleRows(3 * j, 3), joints[0].derivatives.topRows(3));
  }
}

}  // namespace
}  // namespace pushid
