// ident: the three steps of a fit with a large network.
#include "ident/large_network_stage.h"

#include "ident/early_stopping.h"
#include "ident/large_network_fit.h"

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

}  // namespace

bool NeedsGradientTraining(const FitOptions& options) {
  const auto& network = options.model.self_network;
  return !options.hold_network && network != nullptr &&
         static_cast<int>(network->weights.size()) > kMostGaussNewtonWeights;
}

Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const SolveProgress& progress) {
  FitOptions physics = options;
  physics.model.self_network = nullptr;
  physics.table[kRodLift].free = false;  // fitted with the network held, in the end
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
  fit.map = problem.map();
  fit.map.num_weights = static_cast<int>(options.model.self_network->weights.size());
  fit.sigmas = options.sigmas;
  fit.shared = solution.Best().to.shared;
  fit.options.weight_sigma = options.network_prior;
  fit.options.max_iterations = options.max_iterations;
  const Result<LargeNetworkSolution> trained =
      FitLargeNetwork(fit, [&progress](const LargeNetworkIteration& i) {
        if (progress) progress("network by its gradient", i.iteration, i.cost);
        return true;
      });
  if (!trained.ok()) return trained.error();

  FitOptions held = options;
  held.model.self_network = trained.value().Network(*options.model.self_network);
  held.hold_network = true;
  held.start = FitStart::kNominal;
  held.horizons = {0};
  for (size_t i = 0; i < fit.map.fitted.size(); ++i) {
    const FittedParameter& f = fit.map.fitted[i];
    held.table[f.parameter].nominal = ToNatural(f.transform, fit.shared[i]);
  }
  return held;
}

}  // namespace pushid
