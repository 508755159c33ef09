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

// x_nj = 0 is not above 0, so j is not behind n but in front, and for y to the left: of two who
// stand level, each is pushed back that leans forwards, and to the right that leans to the left.
TEST(LdpTable, WhoStandsLevelIsInFrontAndTheLimitBelongsToTheTable) {
  EXPECT_EQ(LdpTable({1, 1, 0.1, 0}, {1, 1, 0, 0}).theta, -1);
  EXPECT_EQ(LdpTable({1, 1, -0.1, 0}, {1, 1, 0, 0}).theta, 0);
  EXPECT_EQ(LdpTable({1, 1, 0, -0.1}, {1, 1, 0, 0}).phi, 1);
  EXPECT_EQ(LdpTable({1, 1, 0, 0.1}, {1, 1, 0, 0}).phi, 0);
  EXPECT_EQ(LdpTable({0, 1, 0, -0.1}, {0.4, 1, 0, 0}).phi, 1) << "the next in a line";
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
  EXPECT_EQ(force.on_n[3], 70.0) << "level counts as to the left: phi < 0 leans at the other";
  EXPECT_EQ(force.on_j[3], 0.0);
  EXPECT_FALSE(Between(terms, At(0, 0, 0.2, 0), At(0.5, 0, 0, 0)).acts) << "out of range";
}

// Eq. 11 with v = v_j - v_n, dt = 1/60 s. n at 0 with -2 m/s, j 0.3 m ahead with 4 m/s: r = -0.3,
// dt v = 0.1, |r| = 0.3, |r - dt v| = 0.4, so b = 0.5 sqrt(0.7^2 - 0.1^2) = sqrt(0.12) = 0.34641,
// U = 150 exp(-b / 0.5) = 75.0245, db/dr = -2 0.7 / (4 b) = -1.010363, and the force on n is
// U db/dr / 0.5 = -151.604 N. (n - j would have b = 0.5 sqrt(0.5^2 - 0.1^2) = 0.24495.)
TEST(LdpPublished, VelocityOfTheEllipseByHand) {
  InteractionTerms terms;
  terms.ldp_published = true;
  EXPECT_NEAR(LdpEllipse<double>({-0.3, 0.0}, {6.0, 0.0}), std::sqrt(0.12), 1e-9);
  const PairForce<double> force =
      Between(terms, At(0.0, 0.0, 0.0, 0.0, -2.0), At(0.3, 0.0, 0.0, 0.0, 4.0));
  EXPECT_NEAR(force.on_n[0], -151.604, 1e-3);
  EXPECT_NEAR(force.on_j[0], 151.604, 1e-3) << "r and v both turn";
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
