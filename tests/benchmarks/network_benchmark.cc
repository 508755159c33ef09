// What a self-force network costs over the 32 recordings of single people: a person-step, the full
// Jacobian by AutoDiffRollout and by Ceres' Jets, an iteration of Levenberg-Marquardt with each
// of Ceres' solvers, and a whole solve. P counts all columns: seven physical ones and the weights.
#include <benchmark/benchmark.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <memory>

#include "datasets/files/random.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"
#include "ident/solver/solver.h"
#include "residuals/jets/autodiff_rollout.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

FitOptions OptionsOf(const char* self_force) {
  const FitOptions preset = MakePreset("tail").value();
  FitOptions options;
  options.preset = preset.preset;
  options.model = preset.model;
  options.table = preset.table;
  options.settling_weight = preset.settling_weight;
  const NetworkShape shape = ParseSelfForce("self_force", self_force).value().network;
  if (shape.any()) options.model.learned = InitialNetwork(shape, 1);
  return options;
}

// Weights as a fit ends with, so that no product has zeros to skip.
FitPoint SomePoint(const FitProblem& problem) {
  FitPoint point = problem.NominalPoint();
  Random random(3);
  for (double& w : point.weights) w += random.Uniform(-0.1, 0.1);
  return point;
}

void PersonStep(benchmark::State& state, const char* self_force) {
  const FitOptions options = OptionsOf(self_force);
  const Scene& scene = SinglePeople().recordings[0].scene;
  const std::vector<ParameterSet<double>> p = {options.table.Values()};
  const auto velocities = InitialVelocities(scene);
  constexpr int kFrames = 72;
  RolloutPath<double> path;
  for (auto _ : state) {
    if (!Rollout(scene, options.model, p, velocities, kFrames, &path).ok) {
      state.SkipWithError("the rollout fails");
    }
    benchmark::DoNotOptimize(path);
  }
  state.counters["s_per_step"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * (kFrames - 1),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// All recordings: residuals and Jacobian; cost: makes the cost function of a recording's problem.
template <typename MakeCost>
void MeasureJacobian(benchmark::State& state, const char* self_force, const MakeCost& make_cost) {
  const FitOptions options = OptionsOf(self_force);
  const std::vector<PendulumRecording>& recordings = SinglePeople().recordings;
  const FitProblem problem(recordings, options);
  const FitPoint point = SomePoint(problem);
  std::vector<std::unique_ptr<ceres::CostFunction>> costs;
  std::vector<std::vector<double>> residuals;
  std::vector<std::vector<std::vector<double>>> jacobians;
  for (const PendulumRecording& recording : recordings) {
    const auto rollout =
        MakeRolloutProblem(recording, options.model, problem.map(), options.sigmas, 1.0, 0);
    costs.push_back(make_cost(rollout));
    residuals.emplace_back(rollout->num_residuals());
    jacobians.emplace_back();
    for (int size : rollout->layout.BlockSizes()) {
      jacobians.back().emplace_back(static_cast<size_t>(size) * rollout->num_residuals());
    }
  }
  std::vector<const double*> blocks = {point.shared.data()};
  if (!point.weights.empty()) blocks.push_back(point.weights.data());
  for (auto _ : state) {
    for (size_t i = 0; i < costs.size(); ++i) {
      std::vector<double*> pointers;
      for (auto& jacobian : jacobians[i]) pointers.push_back(jacobian.data());
      if (!costs[i]->Evaluate(blocks.data(), residuals[i].data(), pointers.data())) {
        state.SkipWithError("a rollout fails");
      }
    }
  }
  state.counters["P"] = static_cast<double>(point.shared.size() + point.weights.size());
}

void NetworkJacobian(benchmark::State& state, const char* self_force) {
  MeasureJacobian(state, self_force,
                  [](const auto& rollout) { return std::make_unique<AutoDiffRollout>(rollout); });
}

template <int kStride>
void NetworkJacobianByJets(benchmark::State& state, const char* self_force) {
  MeasureJacobian(state, self_force, [](const auto& rollout) {
    auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<RolloutResidual, kStride>>(
        new RolloutResidual{rollout});
    for (int size : rollout->layout.BlockSizes()) cost->AddParameterBlock(size);
    cost->SetNumResiduals(rollout->num_residuals());
    return cost;
  });
}

void NetworkSolve(benchmark::State& state, const char* self_force) {
  const FitOptions options = OptionsOf(self_force);
  const FitProblem problem(SinglePeople().recordings, options);
  Solution solution;
  for (auto _ : state) solution = Solve(problem);
  if (!solution.ok()) {
    state.SkipWithError("no usable start");
    return;
  }
  state.counters["cost"] = solution.start.cost;
  state.counters["iterations"] = solution.start.iterations;
}

void RegisterAll() {
  for (const char* self_force : {"none", "mlp:4", "mlp:16", "ldp:8:4"}) {
    const std::string name = self_force;
    benchmark::RegisterBenchmark(("PersonStep/" + name).c_str(), PersonStep, self_force)
        ->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark(("NetworkJacobian/" + name).c_str(), NetworkJacobian, self_force)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("NetworkJacobianByJets/4/mlp:16", NetworkJacobianByJets<4>, "mlp:16")
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("NetworkJacobianByJets/16/mlp:16", NetworkJacobianByJets<16>,
                               "mlp:16")
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("NetworkJacobianByJets/64/mlp:16", NetworkJacobianByJets<64>,
                               "mlp:16")
      ->Unit(benchmark::kMillisecond);
  for (const char* self_force : {"mlp:4", "mlp:16"}) {
    benchmark::RegisterBenchmark((std::string("NetworkSolve/") + self_force).c_str(), NetworkSolve,
                                 self_force)
        ->Unit(benchmark::kMillisecond);
  }
}

const bool kRegistered = (RegisterAll(), true);

}  // namespace
}  // namespace pushid
