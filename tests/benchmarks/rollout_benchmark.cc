// What one evaluation costs: a step, a rollout, and the full Jacobian over 32 recordings by
// AutoDiffRollout (the library's way) against Jets at strides 4, 16 and full width (Ceres' own).
//
// P counts the columns of the whole problem; a recording of one person has only its own subject's:
//   P =  6: 6 shared
//   P = 12: 12 shared
//   P = 64: 16 shared, and 12 of them again for each of 4 subjects; 28 columns in each recording
#include <benchmark/benchmark.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include <memory>
#include <set>

#include "residuals/jets/autodiff_rollout.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

// A recording in the middle of a push's tail, for a single step.
void IpmStep(benchmark::State& state) {
  const PendulumRecording& recording = SinglePeople().recordings[0];
  const ModelOptions options;
  const ParameterSet<double> p = PublishedTailParameters();
  const std::vector<SelfForce> self = SelfForces(recording.scene, options);
  const Body& body = recording.scene.people[0].body;
  PendulumState<double> pose = recording.states[0][20];
  for (auto _ : state) {
    benchmark::DoNotOptimize(pose);
    const NetForce<double> force = NetForceAt(recording.scene, options, self[0], p, 0, 20,
                                              PosedPendulum<double>(pose), pose.qd);
    benchmark::DoNotOptimize(
        Step(pose, Acceleration(body, force.angles, pose.qd, force.Total()), recording.scene.dt));
  }
}
BENCHMARK(IpmStep)->Unit(benchmark::kNanosecond);

// A step of the model with feet that hold and step, in the middle of a swing.
void IpmStepOfStance(benchmark::State& state) {
  const PendulumRecording& recording = SinglePeople().recordings[0];
  ModelOptions options;
  options.stance = Stance::kSteps;
  const ParameterSet<double> p = PublishedStanceParameters();
  const std::vector<SelfForce> self = SelfForces(recording.scene, options);
  const Body& body = recording.scene.people[0].body;
  PendulumState<double> pose = recording.states[0][20];
  pose.feet.swings = 1;
  pose.feet.clock = 0.1;
  pose.feet.swing_time = 0.3;
  for (auto _ : state) {
    benchmark::DoNotOptimize(pose);
    const NetForce<double> force = NetForceAt(recording.scene, options, self[0], p, 0, 20,
                                              PosedPendulum<double>(pose), pose.qd);
    PendulumState<double> next =
        Step(pose,
             AccelerationOnGround(body, force.angles, pose.qd, force.Total(), force.ground,
                                  force.feet_velocity, recording.scene.dt),
             recording.scene.dt);
    next.feet = force.next_feet;
    benchmark::DoNotOptimize(next);
  }
}
BENCHMARK(IpmStepOfStance)->Unit(benchmark::kNanosecond);

// 72 frames: the mean length.
void RolloutOfDoubles(benchmark::State& state) {
  const Scene& scene = SinglePeople().recordings[0].scene;
  const std::vector<ParameterSet<double>> p = {PublishedTailParameters()};
  const auto velocities = InitialVelocities(scene);
  RolloutPath<double> path;
  for (auto _ : state) {
    if (!Rollout(scene, {}, p, velocities, 72, &path).ok) state.SkipWithError("the rollout fails");
    benchmark::DoNotOptimize(path);
  }
  state.SetLabel("72 frames");
}
BENCHMARK(RolloutOfDoubles)->Unit(benchmark::kMicrosecond);

// The first `shared` of these are fitted, the first `pooled` of them by subject too.
ParameterMap MapOf(int shared, int pooled) {
  constexpr Parameter kOrder[] = {kMu,    kKpTheta, kAx,  kTailGain,   kTailTime,     kKdTheta,
                                  kKpPhi, kKdPhi,   kMuY, kTailTorque, kTailExponent, kBx,
                                  kAy,    kBy,      kTx,  kTy};
  ParameterMap map;
  map.values = PublishedTailParameters();
  for (int i = 0; i < shared; ++i) {
    map.fitted.push_back({kOrder[i], Transform::kIdentity, i < pooled ? i : -1});
  }
  map.num_deviations = pooled;
  return map;
}

// All recordings at the published parameters, with room for their Jacobians.
struct JacobianProblem {
  std::vector<std::shared_ptr<const RolloutProblem>> recordings;
  std::vector<std::vector<double>> blocks;                  // shared, then a subject's (zero)
  std::vector<std::vector<double>> residuals;               // by recording
  std::vector<std::vector<std::vector<double>>> jacobians;  // by recording and block
  std::string label;

  explicit JacobianProblem(int columns) {
    const int shared = columns == 64 ? 16 : columns, pooled = columns == 64 ? 12 : 0;
    const ParameterMap map = MapOf(shared, pooled);
    ModelOptions options;
    options.friction = FrictionKind::kAnisotropic;
    std::set<std::string> subjects;
    for (const PendulumRecording& recording : SinglePeople().recordings) {
      recordings.push_back(MakeRolloutProblem(recording, options, map, {}, 1.0, 0));
      subjects.insert(recording.subject_ids[0]);
      residuals.emplace_back(recordings.back()->num_residuals());
      jacobians.emplace_back();
      for (int size : recordings.back()->layout.BlockSizes()) {
        jacobians.back().emplace_back(residuals.back().size() * size);
      }
    }
    blocks.emplace_back();
    for (const FittedParameter& f : map.fitted) blocks[0].push_back(map.values[f.parameter]);
    if (pooled > 0) blocks.emplace_back(pooled, 0.0);
    const int people = static_cast<int>(subjects.size());
    label = "P = " + std::to_string(shared + people * pooled) + ": " + std::to_string(shared) +
            " shared";
    if (pooled > 0) {
      label += " + " + std::to_string(people) + " subjects x " + std::to_string(pooled);
    }
    label += "; " + std::to_string(shared + pooled) + " columns in each of " +
             std::to_string(recordings.size()) + " " + SinglePeople().origin + " recordings";
  }

  // Evaluates every recording's cost function.
  bool Evaluate(const std::vector<std::unique_ptr<ceres::CostFunction>>& costs) {
    std::vector<const double*> parameters;
    for (const auto& block : blocks) parameters.push_back(block.data());
    std::vector<double*> pointers(blocks.size());
    for (size_t r = 0; r < costs.size(); ++r) {
      for (size_t b = 0; b < blocks.size(); ++b) pointers[b] = jacobians[r][b].data();
      if (!costs[r]->Evaluate(parameters.data(), residuals[r].data(), pointers.data())) {
        return false;
      }
    }
    return true;
  }
};

// make: from a recording's problem to its cost function.
template <typename Make>
void MeasureJacobian(benchmark::State& state, const Make& make) {
  JacobianProblem problem(static_cast<int>(state.range(0)));
  std::vector<std::unique_ptr<ceres::CostFunction>> costs;
  for (const auto& recording : problem.recordings) costs.push_back(make(recording));
  for (auto _ : state) {
    if (!problem.Evaluate(costs)) state.SkipWithError("a rollout fails");
    benchmark::ClobberMemory();
  }
  state.SetLabel(problem.label);
}

void JacobianByAutodiff(benchmark::State& state) {
  MeasureJacobian(state,
                  [](const auto& problem) { return std::make_unique<AutoDiffRollout>(problem); });
}

template <int kStride>
void JacobianByJets(benchmark::State& state) {
  MeasureJacobian(state, [](const auto& problem) {
    auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<RolloutResidual, kStride>>(
        new RolloutResidual{problem});
    for (int size : problem->layout.BlockSizes()) cost->AddParameterBlock(size);
    cost->SetNumResiduals(problem->num_residuals());
    return cost;
  });
}

// The argument is P; full width is the number of columns of one recording.
BENCHMARK(JacobianByAutodiff)->Unit(benchmark::kMillisecond)->Arg(6)->Arg(12)->Arg(64);
BENCHMARK(JacobianByJets<4>)->Unit(benchmark::kMillisecond)->Arg(6)->Arg(12)->Arg(64);
BENCHMARK(JacobianByJets<16>)->Unit(benchmark::kMillisecond)->Arg(6)->Arg(12)->Arg(64);
BENCHMARK(JacobianByJets<6>)->Unit(benchmark::kMillisecond)->Arg(6);
BENCHMARK(JacobianByJets<12>)->Unit(benchmark::kMillisecond)->Arg(12);
BENCHMARK(JacobianByJets<28>)->Unit(benchmark::kMillisecond)->Arg(64);

}  // namespace
}  // namespace pushid
