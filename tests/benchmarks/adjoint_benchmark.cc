// What one adjoint gradient over the 32 recordings of single people costs: cost alone and with its
// gradient, by network.
//
// ldp:256:32 is LDP's own network, whose released PyTorch code needs 18.6 s for one epoch, forward
// and backward, over the same 32 recordings on one core.
#include <benchmark/benchmark.h>

#include <memory>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/large_networks/large_network_fit.h"
#include "ident/parameters/fit_options.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

// The last two with LDP's law of the rod, alone and beside its self force.
const LearnedTerms& Network(int64_t index) {
  static const std::vector<int> hidden = {256, 128, 256};
  static const LearnedTerms networks[] = {
      {{NetworkKind::kMlp, 4}, {}},
      {{NetworkKind::kLdp, 64, 16}, {}},
      {{NetworkKind::kLdp, 256, 32}, {}},
      {{}, {}, {RodKind::kLdp, hidden}},
      {{NetworkKind::kLdp, 256, 32}, {}, {RodKind::kLdp, hidden}}};
  return networks[index];
}

// Weights at the start of a fit, with small outputs instead of zero: people move nearly as without.
std::vector<double> SomeWeights(const LearnedTerms& network) {
  std::vector<double> weights = InitialNetwork(network.shape, 7, network.rod)->weights;
  Random random(7);
  for (double& weight : weights) {
    if (weight == 0.0) weight = random.Uniform(-0.01, 0.01);
  }
  return weights;
}

// Arguments: the network, and whether with the gradient.
void Adjoint(benchmark::State& state) {
  const LearnedTerms& network = Network(state.range(0));
  ModelOptions options;
  options.learned = std::make_shared<const LearnedTerms>(network);
  ParameterMap map;
  map.values = PublishedTailParameters();
  map.fitted = {{kMu, Transform::kLog}, {kKpTheta, Transform::kLog}, {kAx, Transform::kIdentity}};
  map.num_weights = network.num_weights();
  std::vector<double> shared;
  for (const FittedParameter& f : map.fitted) {
    shared.push_back(ToFitted(f.transform, map.values[f.parameter]));
  }
  std::vector<AdjointRecording> recordings;
  int steps = 0;
  for (const PendulumRecording& recording : SinglePeople().recordings) {
    recordings.push_back({&recording});
    steps += recording.num_frames() - 1;
  }
  auto adjoint = AdjointGradient::Create(recordings, options, map, {}).value();
  const std::vector<double> weights = SomeWeights(network);
  std::vector<double> by_shared(shared.size()), by_weight(weights.size());
  for (auto _ : state) {
    const bool all = state.range(1) != 0;
    const AdjointCost cost =
        adjoint.Evaluate(shared.data(), weights.data(), all ? by_shared.data() : nullptr,
                         all ? by_weight.data() : nullptr);
    if (!cost.ok()) state.SkipWithError("a rollout fails");
    benchmark::ClobberMemory();
  }
  state.SetLabel(LearnedName(network) + ", " + std::to_string(network.num_weights()) + " weights" +
                 (state.range(1) != 0 ? ", gradient, " : ", cost alone, ") +
                 std::to_string(recordings.size()) + " " + SinglePeople().origin + " recordings, " +
                 std::to_string(steps) + " person-steps");
}
BENCHMARK(Adjoint)->Unit(benchmark::kMillisecond)->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}});

// A training as it is used. The label has the cost of its first and its last pass. Arguments: the
// network, and ten times the prior's standard deviation (0: none).
void Training(benchmark::State& state) {
  LargeNetworkFit fit;
  fit.model.learned = InitialNetwork(Network(state.range(0)).shape, 1);
  fit.map.values = PublishedTailParameters();
  for (const PendulumRecording& r : SinglePeople().recordings) {
    fit.training.push_back({&r, 1.0 / std::sqrt(r.num_frames() - 1.0)});
  }
  fit.options.weight_sigma = 0.1 * state.range(1);
  LargeNetworkSolution s;
  for (auto _ : state) s = FitLargeNetwork(fit).value();
  state.SetLabel(LearnedName(Network(state.range(0))) + ": " +
                 std::to_string(s.passes.front().cost) + " -> " +
                 std::to_string(s.passes.back().cost));
}
BENCHMARK(Training)
    ->Unit(benchmark::kSecond)
    ->ArgsProduct({{1, 2}, {0, 1, 3, 10, 30}})
    ->Iterations(1);

}  // namespace
}  // namespace pushid
