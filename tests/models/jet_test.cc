// Jets against derivatives by hand, against ceres' own, and over these for second derivatives.
#include "models/jet.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <random>

namespace pushid {
namespace {

// By hand: f(x, y) = x^2 y / 2 at (3, 4) is 18, with df = (x y, x^2 / 2) = (12, 4.5).
TEST(Jet, ByHand) {
  using D = JetOf<double, 2>;
  const D x = D::Input(3.0, 0), y = D::Input(4.0, 1);
  const D f = 0.5 * x * x * y;
  EXPECT_EQ(f.a, 18.0);
  EXPECT_EQ(f.Slope(0), 12.0);
  EXPECT_EQ(f.Slope(1), 4.5);
}

// Every function and operator there is, for any scalar.
template <typename T>
T Everything(const T& x, const T& y) {
  using std::cos, std::exp, std::sin, std::sqrt, std::tanh;
  T sum = sqrt(x * x + y * y + 1e-3) - 2.0 * sin(x) / (cos(y) + 3.0) + tanh(x * y) * 0.3;
  sum += exp(-x / 2.0);
  sum -= y / (1.0 + x * x);
  sum *= 1.0 - y;
  sum /= 2.0 + cos(x);
  return -sum;
}

TEST(Jet, AgreesWithJets) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  for (int trial = 0; trial < 100; ++trial) {
    const double x = any(engine), y = any(engine);
    using Jet = ceres::Jet<double, 2>;
    using D = JetOf<double, 2>;
    const Jet expected = Everything(Jet(x, 0), Jet(y, 1));
    const D actual = Everything(D::Input(x, 0), D::Input(y, 1));
    EXPECT_NEAR(actual.a, expected.a, 1e-14);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(actual.Slope(i), expected.v[i], 1e-13);
    EXPECT_EQ(RealPart(actual), actual.a);
  }
}

// The derivative of a derivative: a jet over Jets against a difference of Jets.
TEST(Jet, OverJetsGivesSecondDerivatives) {
  using Jet = ceres::Jet<double, 1>;
  using D = JetOf<Jet, 1>;
  constexpr double kStep = 1e-5;
  for (double x : {-1.5, 0.2, 1.1}) {
    for (double y : {-0.7, 0.4}) {
      const D f = Everything(D::Input(Jet(x), 0), D::Constant(Jet(y, 0)));
      const auto slope = [&](double at) { return Everything(Jet(x, 0), Jet(at)).v[0]; };
      EXPECT_NEAR(f.Slope(0).v[0], (slope(y + kStep) - slope(y - kStep)) / (2.0 * kStep), 1e-8);
      EXPECT_EQ(RealPart(f), f.a.a);
    }
  }
  EXPECT_EQ(DerivativeOrder<double>::value, 0);
  EXPECT_EQ(DerivativeOrder<Jet>::value, 1);
  EXPECT_EQ(DerivativeOrder<D>::value, 2);
}

}  // namespace
}  // namespace pushid
