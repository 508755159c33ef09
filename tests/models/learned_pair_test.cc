// A learned interaction: silent without load, the same however people are numbered.
#include <gtest/gtest.h>

#include <algorithm>

#include "models/learned_terms.h"
#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ParameterSet<double> TouchingParameters() {
  ParameterSet<double> p{};
  p[kMu] = 25.0, p[kKpTheta] = 1650.0, p[kKpPhi] = 1750.0, p[kKdTheta] = 85.0, p[kKdPhi] = 75.0;
  p[kContactStiffness] = 3000.0, p[kContactDamping] = 200.0;
  p[kContactDistance] = 0.6, p[kContactKappa] = 0.6, p[kContactHeight] = 0.5;
  return p;
}

std::vector<double> PairWeights(const PairShape& shape, Random* random) {
  std::vector<double> weights(shape.num_weights());
  for (double& w : weights) w = random->Uniform(-1.0, 1.0);
  return weights;
}

// Two people who face each other's backs, `apart` metres from each other; at frame 0 they stood
// 0.6 m apart.
struct Two {
  Pair pair{{60.0, 0.9, 0.08}, {90.0, 1.0, 0.1}, FirstPose(), FirstPose({0.6, 0.02, 0.0, 0.0})};
  PendulumState<double> n, j;
  explicit Two(double apart) {
    j.q = {apart, 0.02, 0.0, 0.0};
    n.qd = {0.4, 0.1, 0.2, -0.1};
  }
};

TEST(LearnedPair, SizesAndNames) {
  EXPECT_EQ(PairShape{}.num_weights(), 0);
  EXPECT_EQ(PairShape{{4}}.num_weights(), 11 * 4 + 5 * 4);
  EXPECT_EQ((PairShape{{512, 512}, true}.num_weights()), 270340) << "LDP's";
  EXPECT_EQ(PairName({{4}}), "network:4");
  EXPECT_EQ((PairName({{8, 3}})), "network:8-3");
  EXPECT_EQ((PairName({{8, 3}, true})), "ldp_network:8-3");
}

TEST(LearnedPair, IsSilentWithoutLoad) {
  Random random(5);
  const PairShape shape{{4}};
  const std::vector<double> weights = PairWeights(shape, &random);
  for (const double apart : {0.601, 0.7, 5.0}) {
    const Two two(apart);
    PairForce<double> force;
    AddLearnedPair(shape, weights.data(), two.pair, TouchingParameters(), two.n, two.j, &force);
    EXPECT_FALSE(force.acts) << apart;
    EXPECT_EQ(force.on_n.norm() + force.on_j.norm(), 0.0) << apart;
  }
  // Under load it fades in.
  double last = 0.0;
  for (const double apart : {0.57, 0.54, 0.45}) {
    const Two two(apart);
    PairForce<double> force;
    AddLearnedPair(shape, weights.data(), two.pair, TouchingParameters(), two.n, two.j, &force);
    EXPECT_TRUE(force.acts);
    EXPECT_GT(force.on_n.norm(), last) << apart;
    last = force.on_n.norm();
  }
}

TEST(LearnedPair, EachAsksAlone) {
  Random random(6);
  const PairShape shape{{3, 2}};
  const std::vector<double> weights = PairWeights(shape, &random);
  const Two two(0.45);
  PairForce<double> one, other;
  AddLearnedPair(shape, weights.data(), two.pair, TouchingParameters(), two.n, two.j, &one);
  AddLearnedPair(shape, weights.data(), two.pair.Swapped(), TouchingParameters(), two.j, two.n,
                 &other);
  EXPECT_LT((one.on_n - other.on_j).norm(), 1e-12);
  EXPECT_LT((one.on_j - other.on_n).norm(), 1e-12);
  EXPECT_GT((one.on_n + one.on_j).norm(), 1.0) << "not mutual";
}

// One rectified unit that sees dx: F_x on n = 170 N (2 max(0, dx / 0.4 + 1) + 0.5), without contact
// and whatever n weighs; nothing from 0.5 m on.
TEST(LearnedPair, LdpsActsOnEveryNeighbourInRange) {
  const PairShape shape{{1}, true};
  std::vector<double> weights(shape.num_weights(), 0.0);
  weights[0] = 1.0, weights[10] = 1.0, weights[11] = 2.0, weights[12] = 0.5;
  ParameterSet<double> p{};
  p[kNeighbourRange] = 0.5;
  const auto on = [&](double apart) {
    const Two two(apart);
    PairForce<double> force;
    AddLearnedPair(shape, weights.data(), two.pair, p, two.n, two.j, &force);
    return force;
  };
  const double unit = 2.0 * 85.0;
  EXPECT_NEAR(on(0.3).on_n[0], unit * (2.0 * 0.25 + 0.5), 1e-10);
  EXPECT_NEAR(on(0.3).on_j[0], unit * (2.0 * 1.75 + 0.5), 1e-10);
  EXPECT_NEAR(on(0.45).on_n[0], unit * 0.5, 1e-10) << "rectified";
  EXPECT_EQ(on(0.3).on_n.tail<3>().norm(), 0.0);
  EXPECT_FALSE(on(0.499).on_n[0] == 0.0);
  EXPECT_FALSE(on(0.501).acts);
}

// To the last bit, as every term.
TEST(LearnedPair, NumbersOfPeopleDoNotMatter) {
  Random random(7);
  const PairShape shape{{4}};
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = options.interaction.learned = true;
  options.learned =
      std::make_shared<LearnedTerms>(LearnedTerms{{}, PairWeights(shape, &random), {}, shape});
  const auto roll = [&options](const std::vector<int>& order) {
    Scene scene;
    for (int who : order) {
      scene.people.push_back({{60.0 + 8.0 * who, 0.9 + 0.02 * who, 0.1}, {}});
      scene.people.back().start.q = {0.45 * who, 0.03 * who, 0.0, 0.0};
    }
    const auto pushed = std::find(order.begin(), order.end(), 0) - order.begin();
    scene.pushes = {MakeScenePush(static_cast<int>(pushed), 0, PushKind::kExternal,
                                  std::vector<Vector4<double>>(8, {300.0, 0.0, 150.0, 0.0}))};
    RolloutPath<double> path;
    EXPECT_TRUE(
        Rollout(scene, options, {TouchingParameters()}, InitialVelocities(scene), 60, &path).ok);
    return path;
  };
  const RolloutPath<double> plain = roll({0, 1, 2}), mixed = roll({2, 0, 1});
  EXPECT_GT(plain.At(59, 1).q[0], 0.46) << "the neighbour is moved";
  const int place[] = {1, 2, 0};
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(plain.At(59, n).q, mixed.At(59, place[n]).q);
    EXPECT_EQ(plain.At(59, n).qd, mixed.At(59, place[n]).qd);
  }
}

}  // namespace
}  // namespace pushid
