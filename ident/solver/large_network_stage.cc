// ident: the three steps of a fit with a large network.
#include "ident/solver/large_network_stage.h"

#include "ident/solver/early_stopping.h"
#include "ident/solver/large_network_fit.h"

namespace pushid {
namespace {

// What counts, with the weight it has in the cost of a fit.
std::vector<AdjointRecording> Counted(const FitProblem& problem, const std::vector<int>& counts) {
  std::vector<AdjointRecording> counted;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const int recording = static_cast<int>(i);
    counted.push_back({&problem.recordings()[i], problem.Weight(recording, 0), 0});
  }
  return counted;
}

// What the network is trained beside: the physical parameters held where they fit best alone, and
// the lift free, without which a rod's law means nothing.
ParameterMap MapBesideNetwork(const FitOptions& options, const ParameterSet<double>& physics) {
  ParameterMap map;
  map.values = physics;
  const ParameterSpec& lift = options.table[kRodLift];
  if (lift.free) map.fitted = {{lift.id, lift.transform}};
  map.num_weights = static_cast<int>(options.model.learned->weights.size());
  return map;
}

}  // namespace

FitOptions PhysicsAlone(FitOptions options) {
  options.model.learned = nullptr;
  options.table[kRodLift].free = false;  // no rod moves
  return options;
}

Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const SolveProgress& progress) {
  const FitOptions physics = PhysicsAlone(options);
  const FitProblem problem(recordings, physics);
  const Solution solution = Solve(problem, progress);
  if (solution.best < 0) return Error{"the physical model alone has no usable optimum"};

  LargeNetworkFit fit;
  EarlyStoppingSplit split{std::vector<int>(recordings.size(), 1), {}};
  if (options.early_stopping > 0.0) {
    const auto made = SplitForEarlyStopping(problem, options.early_stopping, options.seed);
    if (!made.ok()) return made.error();
    split = made.value();
  }
  fit.training = Counted(problem, split.training);
  fit.held_out = Counted(problem, split.held_out);
  fit.model = options.model;
  fit.map = MapBesideNetwork(options, problem.Parameters(solution.Best().to, ""));
  for (const FittedParameter& f : fit.map.fitted) {
    fit.shared.push_back(ToFitted(f.transform, options.table[f.parameter].nominal));
  }
  fit.shared_prior = SharedPriors(options.table, fit.map);
  fit.options.fit_shared = true;
  fit.sigmas = options.sigmas;
  fit.options.weight_sigma = options.network_prior;
  fit.options.max_iterations = options.max_iterations;
  const Result<LargeNetworkSolution> trained =
      FitLargeNetwork(fit, [&progress](const LargeNetworkIteration& i) {
        if (progress) progress("network by its gradient", i.iteration, i.cost);
        return true;
      });
  if (!trained.ok()) return trained.error();

  FitOptions held = options;
  held.model.learned = trained.value().Network(*options.model.learned);
  held.hold_network = true;
  held.start = FitStart::kNominal;
  held.horizons = {0};
  const ParameterSet<double> learned =
      fit.map.Apply<double>(trained.value().shared.data(), nullptr);
  for (ParameterSpec& spec : held.table.specs) spec.nominal = learned[spec.id];
  return held;
}

}  // namespace pushid
