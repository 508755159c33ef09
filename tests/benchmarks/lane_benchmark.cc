// benchmarks: costs and normal equations of the recordings of single people, side by
// side at every width of vectors, and how near that is to what the processor can do.
//
// The limit: sums and products, as one person's loops count them, at the rate that this core
// reaches in products of small matrices (kernels/vector_kernels.h).
// Quotients, roots, sines and exponentials come on top.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/kernels/vector_kernels.h"
#include "tests/benchmarks/benchmark_recordings.h"

#define PUSHID_WIDTH 64
#define PUSHID_VECTOR_DOUBLES 1
#define PUSHID_LANE_SCALAR "tests/benchmarks/counted_scalar.h"
#include "residuals/lanes/person_lanes_loops.h"

namespace pushid {
namespace {

// Sums and products a second.
double PeakRate(const VectorKernels& kernels) {
  constexpr int kSize = 96, kTimes = 2000;
  const std::vector<double> factor(kSize * kSize, 1e-3);
  std::vector<double> sums(kSize * kSize, 0.0);
  const MatrixAt side = {factor.data(), kSize, kSize, kSize, false};
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTimes; ++i) {
    kernels.add_product(side, side, sums.data(), kSize);
    benchmark::DoNotOptimize(sums.data());
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return 2.0 * kSize * kSize * kSize * kTimes / seconds.count();
}

// Arguments: the preset (0: tail, 1: ldp), the width.
template <LaneSums kSums>
void SumsSideBySide(benchmark::State& state) {
  if (state.range(1) >= static_cast<int>(Supported<PersonLanes>().size())) {
    state.SkipWithError("this processor has no such vectors");
    return;
  }
  static const BenchmarkRecordings people = LoadForBenchmarks("single");
  const FitOptions options = MakePreset(state.range(0) == 0 ? "tail" : "ldp").value();
  const FitProblem fit(people.recordings, options);
  FitPoint point = fit.NominalPoint();
  std::vector<std::shared_ptr<const RolloutProblem>> problems;
  for (const PendulumRecording& recording : people.recordings) {
    problems.push_back(
        MakeRolloutProblem(recording, options.model, fit.map(), options.sigmas, 1.0, 0));
  }
  const std::vector<const double*> blocks = {point.shared.data()};
  const auto groups = [&problems](const PersonLanes& lanes) {
    std::vector<LaneGroup> all;
    for (size_t first = 0; first < problems.size(); first += lanes.lanes) {
      std::vector<const RolloutProblem*> together;
      for (size_t i = first; i < std::min(first + lanes.lanes, problems.size()); ++i) {
        together.push_back(problems[i].get());
      }
      all.emplace_back(together, lanes);
    }
    return all;
  };
  const auto evaluate = [&blocks](const std::vector<LaneGroup>& all, int lanes) {
    for (const LaneGroup& group : all) {
      const std::vector<double const* const*> at(lanes, blocks.data());
      benchmark::DoNotOptimize(group.Evaluate(at, kSums));
    }
  };
  counted = {};
  evaluate(groups(OfWidth<PersonLanes, PUSHID_WIDTH>()), 1);
  const double operations = static_cast<double>(counted.sums_and_products);
  const PersonLanes& lanes = *Supported<PersonLanes>()[state.range(1)];
  const double peak = PeakRate(*Supported<VectorKernels>()[state.range(1)]);
  const std::vector<LaneGroup> all = groups(lanes);
  for (auto _ : state) evaluate(all, lanes.lanes);
  size_t frames = 0;
  for (const PendulumRecording& recording : people.recordings) frames += recording.states[0].size();
  state.counters["million_operations"] = operations / 1e6;
  state.counters["operations_a_frame"] = operations / static_cast<double>(frames);
  state.counters["quotients_and_roots"] = counted.quotients_and_roots / operations;
  state.counters["transcendental"] = counted.transcendental / operations;
  state.counters["peak"] = peak;
  state.counters["rate"] =
      benchmark::Counter(operations, benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(std::to_string(lanes.bits) + "-bit vectors, " +
                 std::to_string(fit.map().num_shared()) + " columns, " +
                 std::to_string(problems.size()) + " " + people.origin + " recordings");
}
void CostsSideBySide(benchmark::State& state) { SumsSideBySide<LaneSums::kSquares>(state); }
void EquationsSideBySide(benchmark::State& state) { SumsSideBySide<LaneSums::kPlain>(state); }
BENCHMARK(CostsSideBySide)->Unit(benchmark::kMillisecond)->ArgsProduct({{0, 1}, {0, 1, 2}});
BENCHMARK(EquationsSideBySide)->Unit(benchmark::kMillisecond)->ArgsProduct({{0, 1}, {0, 1, 2}});

}  // namespace
}  // namespace pushid
