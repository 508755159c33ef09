// A whole fit of the 32 recordings of single people: solving and judging, for both presets, and the
// uncertainty alone. The counters say where it ended.
#include <benchmark/benchmark.h>

#include "ident/fit_result.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

FitOptions OptionsOf(const char* name) {
  const Preset preset = MakePreset(name).value();
  FitOptions options;
  options.preset = preset.name;
  options.model = preset.model;
  options.table = preset.table;
  options.settling_weight = preset.settling_weight;
  return options;
}

void Report(benchmark::State& state, const Solution& solution) {
  const BenchmarkRecordings& data = SinglePeople();
  state.SetLabel(std::to_string(data.recordings.size()) + " " + data.origin + " recordings");
  if (solution.best < 0) {
    state.SkipWithError("no usable start");
    return;
  }
  state.counters["cost"] = solution.Best().cost;
  state.counters["starts"] = static_cast<double>(solution.starts.size());
  state.counters["iterations"] = solution.Best().iterations;
}

void SolveOnly(benchmark::State& state, const char* preset) {
  const FitOptions options = OptionsOf(preset);
  const FitProblem problem(SinglePeople().recordings, options);
  Solution solution;
  for (auto _ : state) solution = Solve(problem);
  Report(state, solution);
}
BENCHMARK_CAPTURE(SolveOnly, tail, "tail")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SolveOnly, ldp, "ldp")->Unit(benchmark::kMillisecond);

// With uncertainty, behaviour and everything else that stands in a result.
void WholeFit(benchmark::State& state, const char* preset) {
  const FitOptions options = OptionsOf(preset);
  for (auto _ : state) benchmark::DoNotOptimize(Fit(SinglePeople().recordings, options));
}
BENCHMARK_CAPTURE(WholeFit, tail, "tail")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(WholeFit, ldp, "ldp")->Unit(benchmark::kMillisecond);

void UncertaintyAlone(benchmark::State& state, const char* preset) {
  const FitOptions options = OptionsOf(preset);
  const FitProblem problem(SinglePeople().recordings, options);
  const Solution solution = Solve(problem);
  if (solution.best < 0) {
    state.SkipWithError("no usable start");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(ComputeUncertainty(problem, solution.Best().to));
}
BENCHMARK_CAPTURE(UncertaintyAlone, tail, "tail")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(UncertaintyAlone, ldp, "ldp")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pushid
