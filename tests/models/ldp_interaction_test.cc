// LDP's interaction against cases worked out by hand.

#include <gtest/gtest.h>

#include "models/interaction.h"

namespace pushid {
namespace {

// LDP's constants, but for the torque about x.
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

TEST(LdpTable, ThirtySixSignsOfTheTable) {
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

TEST(LdpTable, EqualCoordinatesCountAsBehindAndTheLimitBelongsToTheTable) {
  EXPECT_EQ(LdpTable({1, 1, -0.1, 0}, {1, 1, 0, 0}).theta, 1);
  EXPECT_EQ(LdpTable({1, 1, 0, 0.1}, {1, 1, 0, 0}).phi, -1);
  EXPECT_EQ(LdpTable({0, 0, 0.0999, 0}, {1, 0, 0, 0}).theta, 0);
}

// d = 0.3, v = 0:
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

}  // namespace
}  // namespace pushid
