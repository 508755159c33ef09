// A whole fit of the 32 recordings of single people: solving and judging, for both presets, and the
// uncertainty alone; and of the 49 recordings of groups: the Jacobian at 19 to 22 parameters, and
// the solve from one start. The counters say where it ended.
#include <benchmark/benchmark.h>

#include <memory>

#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/fitted_model.h"
#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

FitOptions OptionsOf(const char* name) { return MakePreset(name).value(); }

void Report(benchmark::State& state, const Solution& solution) {
  const BenchmarkRecordings& data = SinglePeople();
  state.SetLabel(std::to_string(data.recordings.size()) + " " + data.origin + " recordings");
  if (!solution.ok()) {
    state.SkipWithError("no usable start");
    return;
  }
  state.counters["cost"] = solution.start.cost;
  state.counters["iterations"] = solution.start.iterations;
}

void SolveOnly(benchmark::State& state, const char* preset) {
  const FitOptions options = OptionsOf(preset);
  Solution solution;
  for (auto _ : state) {
    FitProblem problem(SinglePeople().recordings, options);
    solution = SolveWeighted(&problem).solution;
  }
  Report(state, solution);
}
BENCHMARK_CAPTURE(SolveOnly, tail, "tail")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SolveOnly, ldp, "ldp")->Unit(benchmark::kMillisecond);

// A fit of these recordings by the innovation likelihood, drift and noise together.
void SolveByInnovations(benchmark::State& state) {
  FitOptions options = MakeFitOptions({{"preset", "tail"}, {"likelihood", "innovation"}}).value();
  options.num_threads = 1;
  if (MaybeError error = PrepareFit(SinglePeople().recordings, &options)) {
    state.SkipWithError(error->ToString().c_str());
    return;
  }
  Solution solution;
  for (auto _ : state) {
    FitProblem problem(SinglePeople().recordings, options);
    solution = SolveFit(&problem).solution;
  }
  Report(state, solution);
}
BENCHMARK(SolveByInnovations)->Unit(benchmark::kMillisecond);

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
  if (!solution.ok()) {
    state.SkipWithError("no usable start");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(ComputeUncertainty(problem, solution.start.to));
}
BENCHMARK_CAPTURE(UncertaintyAlone, tail, "tail")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(UncertaintyAlone, ldp, "ldp")->Unit(benchmark::kMillisecond);

FitOptions GroupOptions(SelfForceKind self_force) {
  FitOptions options = MakePreset("group").value();
  options.pool = "none";
  options.self_force = self_force;
  FreeTerms(&options);
  return options;
}

FitOptions PooledOptions() {
  FitOptions options = GroupOptions(SelfForceKind::kLinear);
  options.pool_by = kSettingLabel;
  options.pooling_sigma = 0.3;
  for (ParameterSpec& spec : options.table.specs) spec.pooled = spec.free;
  return options;
}

// What Ceres asks for at a point: every recording's condensed rows and their derivatives.
void GroupJacobian(benchmark::State& state, const FitOptions& options) {
  const FitProblem fit(Groups().recordings, options);
  FitPoint point = fit.NominalPoint();
  std::vector<std::unique_ptr<CondensedRollout>> residuals;
  std::vector<std::vector<const double*>> blocks;
  std::vector<std::vector<double>> values, storage;
  std::vector<std::vector<double*>> jacobians;
  int columns = 0;
  for (const PendulumRecording& recording : Groups().recordings) {
    const auto problem =
        MakeRolloutProblem(recording, options.model, fit.map(), options.sigmas, 1.0, 0);
    residuals.push_back(std::make_unique<CondensedRollout>(problem));
    const int rows = residuals.back()->num_residuals();
    columns = problem->layout.num_columns();
    blocks.push_back({point.shared.data()});
    for (const std::string& unit : problem->layout.units) {
      if (fit.map().num_deviations > 0) blocks.back().push_back(point.unit[unit].data());
    }
    values.emplace_back(rows);
    storage.emplace_back(rows * columns);
    jacobians.emplace_back();
    double* at = storage.back().data();
    for (int size : residuals.back()->parameter_block_sizes()) {
      jacobians.back().push_back(at);
      at += rows * size;
    }
  }
  for (auto _ : state) {
    for (size_t i = 0; i < residuals.size(); ++i) {
      if (!residuals[i]->Evaluate(blocks[i].data(), values[i].data(), jacobians[i].data())) {
        state.SkipWithError("a rollout fails");
      }
    }
    benchmark::ClobberMemory();
  }
  state.SetLabel(std::to_string(columns) + " columns, " +
                 std::to_string(Groups().recordings.size()) + " " + Groups().origin +
                 " recordings");
}
BENCHMARK_CAPTURE(GroupJacobian, contact, GroupOptions(SelfForceKind::kNone))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(GroupJacobian, linear_and_contact, GroupOptions(SelfForceKind::kLinear))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(GroupJacobian, pooled, PooledOptions())->Unit(benchmark::kMillisecond);

void GroupSolve(benchmark::State& state, const FitOptions& options) {
  const FitProblem problem(Groups().recordings, options);
  Solution solution;
  for (auto _ : state) solution = Solve(problem);
  state.SetLabel(std::to_string(Groups().recordings.size()) + " " + Groups().origin +
                 " recordings");
  if (!solution.ok()) {
    state.SkipWithError("no usable start");
    return;
  }
  state.counters["cost"] = solution.start.cost;
  state.counters["iterations"] = solution.start.iterations;
}
BENCHMARK_CAPTURE(GroupSolve, contact, GroupOptions(SelfForceKind::kNone))
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(GroupSolve, linear_and_contact, GroupOptions(SelfForceKind::kLinear))
    ->Unit(benchmark::kSecond);

BENCHMARK_CAPTURE(GroupSolve, group_preset, PooledOptions())->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pushid
