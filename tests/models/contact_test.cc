// The contact between two people: mutual, smooth, load-free at the start, without energy of its
// own.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "models/interaction.h"
#include "models/rollout.h"

namespace pushid {
namespace {

ParameterSet<double> ContactParameters(double height) {
  ParameterSet<double> p{};
  p[kContactStiffness] = 2500.0;
  p[kContactDistance] = 0.4;
  p[kContactKappa] = 0.5;
  p[kContactDamping] = 150.0;
  p[kContactHeight] = height;
  return p;
}

template <typename T>
PairForce<T> Contact(const Pair& pair, const ParameterSet<T>& p, const PendulumState<T>& n,
                     const PendulumState<T>& j) {
  InteractionTerms terms;
  terms.spring = terms.damping = true;
  return InteractionBetween(terms, pair, p, n, j);
}

Pair PairApart(double distance) {
  Pair pair;
  pair.body_n = {70.0, 0.95, 0.1};
  pair.body_j = {90.0, 1.02, 0.08};
  pair.first_j = FirstPose({distance, 0.05, 0.02, -0.01});
  return pair;
}

PendulumState<double> Near(double x, double velocity) {
  PendulumState<double> state;
  state.q = {x, 0.02, 0.06, -0.03};
  state.qd = {velocity, -0.1, 0.4, 0.2};
  return state;
}

PendulumState<double> AtRest(const Vector4<double>& q) { return {q, Vector4<double>::Zero()}; }

TEST(Contact, NobodyIsLoadedWhereHeStoodAtTheStart) {
  for (double distance : {0.1, 0.3, 0.4, 0.6}) {
    const Pair pair = PairApart(distance);
    const PairForce<double> force = Contact<double>(pair, ContactParameters(0.5),
                                                    AtRest(pair.first_n.q), AtRest(pair.first_j.q));
    EXPECT_FALSE(force.acts) << distance;
    EXPECT_EQ(force.on_n.norm(), 0.0);
  }
}

TEST(Contact, PushesApartAndIsMutual) {
  const Pair pair = PairApart(0.6);
  const PairForce<double> force =
      Contact(pair, ContactParameters(0.5), Near(0.35, 0.8), Near(0.6, 0.0));
  ASSERT_TRUE(force.acts);
  EXPECT_LT(force.on_n[0], 0.0);  // n stands behind j and is pushed back
  EXPECT_GT(force.on_j[0], 0.0);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(force.on_n[i], -force.on_j[i], 1e-12);
}

// Whichever is called first, the forces are the same.
TEST(Contact, DoesNotDependOnTheOrder) {
  const Pair pair = PairApart(0.6);
  const Pair swapped = pair.Swapped();
  const auto a = Near(0.33, 0.5), b = Near(0.58, -0.2);
  const PairForce<double> one = Contact(pair, ContactParameters(0.7), a, b);
  const PairForce<double> other = Contact(swapped, ContactParameters(0.7), b, a);
  ASSERT_TRUE(one.acts);
  EXPECT_LT((one.on_n - other.on_j).norm(), 1e-12 * one.on_n.norm());
  EXPECT_LT((one.on_j - other.on_n).norm(), 1e-12 * one.on_j.norm());
}

// Without damping the generalized forces are minus the gradient of one potential, so that the
// derivative of the force by the states is symmetric over all eight coordinates.
TEST(Contact, SpringHasAPotential) {
  using Jet = ceres::Jet<double, 8>;
  ParameterSet<double> p = ContactParameters(0.6);
  p[kContactDamping] = 0.0;
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = Jet(p[i]);
  const auto a = Near(0.35, 0.0), b = Near(0.6, 0.0);
  PendulumState<Jet> n, j;
  for (int i = 0; i < 4; ++i) {
    n.q[i] = Jet(a.q[i], i);
    j.q[i] = Jet(b.q[i], 4 + i);
    n.qd[i] = j.qd[i] = Jet(0.0);
  }
  const PairForce<Jet> force = Contact(PairApart(0.6), parameters, n, j);
  ASSERT_TRUE(force.acts);
  Eigen::Matrix<double, 8, 8> stiffness;
  for (int row = 0; row < 4; ++row) {
    stiffness.row(row) = force.on_n[row].v.transpose();
    stiffness.row(4 + row) = force.on_j[row].v.transpose();
  }
  EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-9 * stiffness.norm());
}

TEST(Contact, ForceAndSlopeVanishAtFirstTouch) {
  const Pair pair = PairApart(0.6);
  double before = 0.0;
  // Walk n towards j in steps of 0.1 mm: no step of the force where the contact begins.
  for (int i = 0; i <= 1000; ++i) {
    PendulumState<double> n;
    n.q = {0.15 + 1e-4 * i, 0.0, 0.0, 0.0};
    const PendulumState<double> j = AtRest(pair.first_j.q);
    const double now = Contact(pair, ContactParameters(0.5), n, j).on_j[0];
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.3);  // 2500 N/m x 0.1 mm and a little
    before = now;
  }
  EXPECT_GT(before, 20.0);
}

// A push of the first in a row of three reaches the third only through the second.
TEST(Contact, TravelsThroughARow) {
  Scene scene;
  for (int n = 0; n < 3; ++n) {
    ScenePerson person;
    person.body = {80.0, 0.95, 0.0};
    person.start.q = {0.45 * n, 0.0, 0.0, 0.0};
    scene.people.push_back(person);
  }
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       HalfSinePush(scene.people[0].body, 80.0, 12, scene.dt)));
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  ParameterSet<double> p = ContactParameters(0.5);
  p[kMu] = 30.0, p[kKpTheta] = 1800.0, p[kKpPhi] = 1500.0, p[kKdTheta] = p[kKdPhi] = 70.0;
  p[kAx] = -12.0, p[kTailTime] = 0.2;
  RolloutPath<double> path;
  ASSERT_TRUE(Rollout<double>(scene, options, {p, p, p}, InitialVelocities(scene), 120, &path).ok);
  int onset[3] = {0, 0, 0};
  for (int n = 0; n < 3; ++n) {
    while (onset[n] < 119 && path.At(onset[n], n).q[0] - 0.45 * n < 0.02) ++onset[n];
  }
  EXPECT_LT(onset[0], onset[1]);
  EXPECT_LT(onset[1], onset[2]);
  EXPECT_LT(onset[2], 119);
}

}  // namespace
}  // namespace pushid
