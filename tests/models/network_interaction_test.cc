// The interaction network: its derivatives by hand against finite differences, LDP's size, and the
// same numbers through Jets.
#include "models/network_interaction.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "models/interaction.h"
#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

InteractionNetwork RandomNetwork(const std::vector<int>& sizes, Activation activation,
                                 Random* random) {
  InteractionNetwork network;
  network.mlp.activation = activation;
  for (size_t i = 0; i + 1 < sizes.size(); ++i) {
    MlpLayer layer{Eigen::MatrixXd(sizes[i + 1], sizes[i]), Eigen::VectorXd(sizes[i + 1])};
    for (double& w : layer.weights.reshaped()) w = random->Normal() / std::sqrt(sizes[i]);
    for (double& b : layer.bias) b = 0.1 * random->Normal();
    network.mlp.layers.push_back(layer);
  }
  network.scale = {200.0, 100.0, 150.0, 80.0};
  network.deviation.setConstant(0.4);
  return network;
}

ParameterSet<double> NetworkParameters() {
  ParameterSet<double> p{};
  p[kNeighbourRange] = 0.6;
  return p;
}

TEST(Mlp, DerivativesByInput) {
  Random random(8);
  for (Activation activation : {Activation::kTanh, Activation::kRelu}) {
    const Mlp mlp = RandomNetwork({10, 7, 5, 4}, activation, &random).mlp;
    EXPECT_EQ(mlp.num_weights(), 77 + 40 + 24);
    Eigen::VectorXd x(10);
    for (double& v : x) v = random.Normal();
    Eigen::MatrixXd by_input;
    const Eigen::VectorXd y = mlp.Evaluate(x, &by_input);
    EXPECT_EQ(y, mlp.Evaluate(x, nullptr));
    for (int i = 0; i < 10; ++i) {
      Eigen::VectorXd up = x, down = x;
      up[i] += 1e-6, down[i] -= 1e-6;
      const Eigen::VectorXd slope =
          (mlp.Evaluate(up, nullptr) - mlp.Evaluate(down, nullptr)) / 2e-6;
      EXPECT_LT((slope - by_input.col(i)).norm(), 1e-8);
    }
  }
}

TEST(NetworkInteraction, JetsCarryTheDerivativesThrough) {
  using Jet = ceres::Jet<double, 16>;
  Random random(9);
  const InteractionNetwork network = RandomNetwork({10, 6, 4}, Activation::kTanh, &random);
  InteractionTerms terms;
  terms.network = true;
  PendulumState<double> n = RandomState(&random, 0.1), j = RandomState(&random, 0.1);
  j.q[0] += 0.4;
  const auto force_of = [&](const PendulumState<double>& a, const PendulumState<double>& b) {
    return InteractionBetween(terms, &network, Pair{}, NetworkParameters(), a, b);
  };
  PendulumState<Jet> a, b;
  for (int i = 0; i < 4; ++i) {
    a.q[i] = Jet(n.q[i], i), a.qd[i] = Jet(n.qd[i], 4 + i);
    b.q[i] = Jet(j.q[i], 8 + i), b.qd[i] = Jet(j.qd[i], 12 + i);
  }
  ParameterSet<Jet> p;
  for (int i = 0; i < kNumParameters; ++i) p[i] = Jet(NetworkParameters()[i]);
  const PairForce<Jet> jets = InteractionBetween(terms, &network, Pair{}, p, a, b);
  ASSERT_TRUE(jets.acts);
  for (int column = 0; column < 16; ++column) {
    const auto moved = [&](double by) {
      PendulumState<double> x = n, y = j;
      PendulumState<double>& state = column < 8 ? x : y;
      (column % 8 < 4 ? state.q : state.qd)[column % 4] += by;
      return force_of(x, y);
    };
    const PairForce<double> up = moved(1e-6), down = moved(-1e-6);
    for (int row = 0; row < 4; ++row) {
      EXPECT_NEAR(jets.on_n[row].v[column], (up.on_n[row] - down.on_n[row]) / 2e-6, 1e-5);
      EXPECT_NEAR(jets.on_j[row].v[column], (up.on_j[row] - down.on_j[row]) / 2e-6, 1e-5);
    }
  }
}

TEST(NetworkInteraction, LdpsSizeRunsInARollout) {
  Random random(10);
  auto network = std::make_shared<InteractionNetwork>(
      RandomNetwork({10, 512, 512, 4}, Activation::kRelu, &random));
  network->lowest = Vector4<double>(-20, -10, -5, -5);
  network->highest = Vector4<double>(20, 10, 5, 5);
  EXPECT_EQ(network->mlp.num_weights(), 10 * 512 + 512 + 512 * 512 + 512 + 512 * 4 + 4);
  Scene scene = SettlingScene(80.0, 40.0, 3);
  ModelOptions options;
  options.interaction.network = true;
  options.interaction_network = network;
  ParameterSet<double> p = NetworkParameters();
  p[kMu] = 40.0, p[kKpTheta] = p[kKpPhi] = 1800.0, p[kKdTheta] = p[kKdPhi] = 80.0;
  p[kTailTime] = 0.2;
  RolloutPath<double> path;
  ForceTrace trace;
  ASSERT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), 20, &path, &trace).ok);
  EXPECT_GT(trace.At(5, 1)[ForcePart::kInteraction].norm(), 1.0);
  EXPECT_LE(trace.At(5, 0)[ForcePart::kInteraction].cwiseAbs()[0], 20.0);  // one neighbour, clamped
}

}  // namespace
}  // namespace pushid
