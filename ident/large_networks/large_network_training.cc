// ident: a large network's training inside a fit. Programs that link this library have it as
// LargeNetworkTraining() (solver/solver.h).
#include "ident/large_networks/large_network_fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

// The recordings with the weight that each has in the cost of a fit, and the parameters of its
// people.
std::vector<AdjointRecording> Weighed(const FitProblem& problem) {
  const FitPoint point = problem.NominalPoint();
  std::vector<AdjointRecording> weighed;
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    const PendulumRecording& recording = problem.recordings()[i];
    weighed.push_back({&recording, problem.Weight(static_cast<int>(i), 0), 0});
    for (const std::string& unit : PoolingUnits(recording, problem.map().pool_by)) {
      weighed.back().held.push_back(problem.Parameters(point, unit));
    }
  }
  return weighed;
}

Result<FitOptions> TrainByGradient(const std::vector<PendulumRecording>& recordings,
                                   const FitOptions& options, const SolveProgress& progress) {
  const FitProblem physics(recordings, PhysicsAlone(options));
  LargeNetworkFit fit;
  fit.training = Weighed(physics);
  fit.model = options.model;
  fit.map = options.table.Map();
  fit.map.num_weights = static_cast<int>(options.model.learned->weights.size());
  for (const FittedParameter& f : fit.map.fitted) {
    fit.shared.push_back(ToFitted(f.transform, options.table[f.parameter].nominal));
  }
  fit.shared_prior = SharedPriors(options.table, fit.map);
  fit.sigmas = options.sigmas;
  fit.options = OptionsFor(*options.model.learned);
  fit.options.weight_sigma = options.network_prior;
  fit.options.seed = options.seed;
  const Result<LargeNetworkSolution> trained =
      FitLargeNetwork(fit, [&progress](const LargeNetworkPass& p) {
        const std::string failing =
            p.failures > 0 ? ", " + std::to_string(p.failures) + " rollouts leave the domain" : "";
        if (progress) progress("network by its gradient" + failing, p.pass, p.cost);
        return true;
      });
  if (!trained.ok()) return trained.error();
  if (trained.value().passes.back().failures == static_cast<int>(fit.training.size())) {
    return Error{"in the last pass of the training every rollout left the domain"};
  }

  FitOptions held = options;
  held.model.learned = trained.value().Network(*options.model.learned);
  held.hold_network = true;
  held.horizons = {0};
  const ParameterSet<double> learned =
      fit.map.Apply<double>(trained.value().shared.data(), nullptr);
  for (ParameterSpec& spec : held.table.specs) spec.nominal = learned[spec.id];
  return held;
}

}  // namespace
}  // namespace pushid

// The linker keeps this object for the sake of the name (ident/CMakeLists.txt).
extern "C" {
bool pushid_large_networks = (pushid::LargeNetworkTraining() = pushid::TrainByGradient, true);
}
