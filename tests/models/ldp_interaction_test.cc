// LDP's interaction: the exact discrete form against cases worked out by hand, and its smooth
// twins against it.
#include "models/ldp_interaction.h"

#include <gtest/gtest.h>

#include "models/interaction.h"

namespace pushid {
namespace {

// LDP's constants (its released code: both torques 100 N m).
ParameterSet<double> Constants() {
  ParameterSet<double> p{};
  p[kPotentialStrength] = 150.0;
  p[kPotentialLength] = 0.5;
  p[kNeighbourRange] = 0.5;
  p[kLeanTheta] = 100.0;
  p[kLeanPhi] = 70.0;  // told apart from theta's
  return p;
}

PendulumState<double> At(double x, double y, double theta, double phi, double xd = 0.2) {
  PendulumState<double> state;
  state.q = {x, y, theta, phi};
  state.qd[0] = xd;
  return state;
}

PairForce<double> Between(const InteractionTerms& terms, const PendulumState<double>& n,
                          const PendulumState<double>& j) {
  return InteractionBetween(terms, Pair{}, Constants(), n, j);
}

PairForce<double> Discrete(const PendulumState<double>& n, const PendulumState<double>& j) {
  InteractionTerms terms;
  terms.ldp_discrete = true;
  return Between(terms, n, j);
}

// One row of the table: how I lean, how the neighbour leans (-1 backwards, 0 upright, 1 forwards,
// for phi: -1, 0, 1 times 0.15 rad), and the torque on me, in units of its size.
struct SignCase {
  int mine, theirs, torque;
};

// The neighbour in front (x_j > x_n): pushed back when I lean forwards or the other leans back at
// me.
constexpr SignCase kInFront[] = {{-1, -1, -1}, {-1, 0, 0},  {-1, 1, 0}, {0, -1, -1}, {0, 0, 0},
                                 {0, 1, 0},    {1, -1, -1}, {1, 0, -1}, {1, 1, -1}};
// Behind: pushed forwards when I lean back or the other leans forwards at me.
constexpr SignCase kBehind[] = {{-1, -1, 1}, {-1, 0, 1}, {-1, 1, 1}, {0, -1, 0}, {0, 0, 0},
                                {0, 1, 1},   {1, -1, 0}, {1, 0, 0},  {1, 1, 1}};
// To the left (y_j > y_n): phi < 0 leans left, towards the other; a positive torque leans me away.
constexpr SignCase kLeft[] = {{-1, -1, 1}, {-1, 0, 1}, {-1, 1, 1}, {0, -1, 0}, {0, 0, 0},
                              {0, 1, 1},   {1, -1, 0}, {1, 0, 0},  {1, 1, 1}};
// To the right.
constexpr SignCase kRight[] = {{-1, -1, -1}, {-1, 0, 0},  {-1, 1, 0}, {0, -1, -1}, {0, 0, 0},
                               {0, 1, 0},    {1, -1, -1}, {1, 0, -1}, {1, 1, -1}};

TEST(LdpDiscrete, ThirtySixSignsOfTheTable) {
  const auto check = [](const SignCase(&cases)[9], double dx, double dy, int component) {
    for (const SignCase& c : cases) {
      Vector4<double> n(0, 0, 0, 0), j(dx, dy, 0, 0);
      n[component] = 0.15 * c.mine;
      j[component] = 0.15 * c.theirs;
      const LdpTorqueSigns signs = LdpTable(n, j);
      EXPECT_EQ(component == 2 ? signs.theta : signs.phi, c.torque)
          << "component " << component << ", neighbour at " << dx << ", " << dy << ", mine "
          << c.mine << ", theirs " << c.theirs;
      EXPECT_EQ(component == 2 ? signs.phi : signs.theta, 0);
    }
  };
  check(kInFront, 0.3, 0.0, 2);
  check(kBehind, -0.3, 0.0, 2);
  check(kLeft, 0.0, 0.3, 3);
  check(kRight, 0.0, -0.3, 3);
}

TEST(LdpDiscrete, EqualCoordinatesCountAsBehindAndTheLimitBelongsToTheTable) {
  EXPECT_EQ(LdpTable({1, 1, -0.1, 0}, {1, 1, 0, 0}).theta, 1);
  EXPECT_EQ(LdpTable({1, 1, 0, 0.1}, {1, 1, 0, 0}).phi, -1);
  EXPECT_EQ(LdpTable({0, 0, 0.0999, 0}, {1, 0, 0, 0}).theta, 0);
}

// d = 0.3, v = 0 between two who walk alike: b = d, U = 150 exp(-0.6), the slope of exp(-d / 0.5)
// over 1 mm; speed gain 0.8, distance gain 0.5 + 0.2 * 1.25 = 0.75; n leans forwards at j.
TEST(LdpDiscrete, ForceByHand) {
  const PairForce<double> force = Discrete(At(0.0, 0.0, 0.15, 0.0), At(0.3, 0.0, 0.0, 0.0));
  ASSERT_TRUE(force.acts);
  const double slope = 150.0 * (std::exp(-0.3 / 0.5) - std::exp(-0.299 / 0.5)) / 1e-3;
  EXPECT_NEAR(force.on_n[0], 0.8 * 0.75 * slope, 1e-6 * std::abs(slope));
  EXPECT_LT(force.on_n[0], 0.0);
  EXPECT_NEAR(force.on_n[1], 0.0, 0.5);  // the forward difference's own error
  EXPECT_NEAR(force.on_n[2], -0.8 * 0.75 * 100.0, 1e-9);
  EXPECT_EQ(force.on_n[3], 0.0);
  // j stands upright in front of me, who lean on j: j is pushed on.
  EXPECT_NEAR(force.on_j[2], 0.8 * 0.75 * 100.0, 1e-9);
}

TEST(LdpDiscrete, NeedsAMovingNeighbourInRange) {
  EXPECT_FALSE(Discrete(At(0, 0, 0.2, 0), At(0.5, 0, 0, 0)).acts);
  const PairForce<double> still = Discrete(At(0, 0, 0.2, 0, 0.3), At(0.3, 0, 0, 0, 0.05));
  EXPECT_EQ(still.on_n.norm(), 0.0);  // j stands still: n feels nothing, j does
  EXPECT_GT(still.on_j.norm(), 1.0);
}

TEST(LdpDiscrete, SpeedGainIsClamped) {
  const auto torque = [](double speed) {
    return -Discrete(At(0, 0, 0.2, 0, 0.0), At(0.3, 0, 0, 0, speed)).on_n[2];
  };
  EXPECT_NEAR(torque(0.5), 100 * 0.75 * 0.8, 1e-9);
  EXPECT_NEAR(torque(2.0), 100 * 0.75 * 2.0, 1e-9);
  EXPECT_NEAR(torque(30.0), 100 * 0.75 * 10.0, 1e-9);
}

// The same as published: no gains, the exact gradient, and of neighbours who stand, too. d = 0.3:
// F = 150 / 0.5 exp(-0.6); both torques from the table.
TEST(LdpPublished, ForceByHand) {
  InteractionTerms terms;
  terms.ldp_published = true;
  const double repulsion = 300.0 * std::exp(-0.6);
  const PairForce<double> force =
      Between(terms, At(0.0, 0.0, 0.15, -0.15, 0.0), At(0.3, 0.0, 0.0, 0.0, 0.0));
  ASSERT_TRUE(force.acts);
  EXPECT_NEAR(force.on_n[0], -repulsion, 1e-6);
  EXPECT_NEAR(force.on_j[0], repulsion, 1e-6);
  EXPECT_NEAR(force.on_n[1], 0.0, 1e-9);
  EXPECT_EQ(force.on_n[2], -100.0);
  EXPECT_EQ(force.on_j[2], 100.0);
  EXPECT_EQ(force.on_n[3], 0.0) << "equal y counts as to the right: phi < 0 leans away";
  EXPECT_FALSE(Between(terms, At(0, 0, 0.2, 0), At(0.5, 0, 0, 0)).acts) << "out of range";
}

// -grad U by central differences, of carts that move.
TEST(LdpPublished, ForceIsTheSlopeOfThePotential) {
  InteractionTerms terms;
  terms.ldp_published = true;
  const auto n = At(0.0, 0.0, 0.0, 0.0, 0.3), j = At(0.25, -0.2, 0.0, 0.0, 1.7);
  const Eigen::Vector2d v(1.4, 0.0);
  const auto potential = [&](const Eigen::Vector2d& r) {
    return 150.0 * std::exp(-LdpEllipse<double>(r, v) / 0.5);
  };
  const PairForce<double> force = Between(terms, n, j);
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d r(-0.25, 0.2), step = 1e-6 * Eigen::Vector2d::Unit(axis);
    EXPECT_NEAR(force.on_n[axis], -(potential(r + step) - potential(r - step)) / 2e-6, 1e-5);
  }
}

// Away from the switches the twins agree with the exact form.
TEST(LdpSmooth, IsTheDiscreteFormAwayFromItsSwitches) {
  InteractionTerms smooth;
  smooth.potential = smooth.lean = true;
  for (double side : {-1.0, 1.0}) {
    for (double mine : {-0.25, 0.0, 0.25}) {
      const auto n = At(0.0, 0.0, mine, -mine, 0.6),
                 j = At(side * 0.25, -side * 0.2, 0.0, 0.0, 2.5);
      const PairForce<double> exact = Discrete(n, j), twin = Between(smooth, n, j);
      for (int i = 0; i < 4; ++i) {
        const double scale = std::max(10.0, exact.on_n.cwiseAbs().maxCoeff());
        EXPECT_NEAR(twin.on_n[i], exact.on_n[i], 0.06 * scale) << "component " << i;
        EXPECT_NEAR(twin.on_j[i], exact.on_j[i], 0.06 * scale) << "component " << i;
      }
    }
  }
}

TEST(LdpSmooth, EndsWithinItsReach) {
  InteractionTerms smooth;
  smooth.potential = smooth.lean = true;
  const double reach = SmoothLdpReach(Constants());
  EXPECT_LT(Between(smooth, At(0, 0, 0.3, 0), At(reach - 1e-6, 0, 0, 0)).on_n.norm(), 0.01);
  EXPECT_FALSE(Between(smooth, At(0, 0, 0.3, 0), At(reach + 1e-6, 0, 0, 0)).acts);
}

}  // namespace
}  // namespace pushid
