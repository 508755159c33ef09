// ident: a large network's training inside a fit. Programs that link this library have it as
// LargeNetworkTraining() (solver/network_training.h).
#include "ident/large_networks/large_network_fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/network_training.h"

namespace pushid {
namespace {

// What counts, with the weight it has in the cost of a fit, and the parameters of its people.
std::vector<AdjointRecording> Counted(const FitProblem& problem, const FitPoint& point,
                                      const std::vector<int>& counts) {
  std::vector<AdjointRecording> counted;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const PendulumRecording& recording = problem.recordings()[i];
    counted.push_back({&recording, problem.Weight(static_cast<int>(i), 0), 0});
    for (const std::string& unit : PoolingUnits(recording, problem.map().pool_by)) {
      counted.back().held.push_back(problem.Parameters(point, unit));
    }
  }
  return counted;
}

// What the network is trained beside: what is free, where all is trained together; else the
// physical parameters held where they fit best alone, and the lift free, without which a rod's law
// means nothing.
ParameterMap MapBesideNetwork(const FitOptions& options, const ParameterSet<double>& physics) {
  ParameterMap map;
  if (options.network_training == NetworkTraining::kTogether) map = options.table.Map();
  map.num_weights = static_cast<int>(options.model.learned->weights.size());
  if (options.network_training == NetworkTraining::kTogether) return map;
  map.values = physics;
  const ParameterSpec& lift = options.table[kRodLift];
  if (lift.free) map.fitted = {{lift.id, lift.transform}};
  return map;
}

// The deviations of a fit's pooled parameters, as another fit found them; what that did not pool
// does not deviate.
std::map<std::string, std::vector<double>> DeviationsOf(const FitPoint& point,
                                                        const ParameterMap& found,
                                                        const ParameterMap& wanted) {
  std::map<std::string, std::vector<double>> deviations;
  for (const auto& [unit, values] : point.unit) {
    std::vector<double>& of_unit = deviations[unit];
    of_unit.assign(wanted.num_deviations, 0.0);
    for (const FittedParameter& to : wanted.fitted) {
      for (const FittedParameter& from : found.fitted) {
        const bool same = from.parameter == to.parameter;
        if (same && from.deviation >= 0 && to.deviation >= 0) {
          of_unit[to.deviation] = values[from.deviation];
        }
      }
    }
  }
  return deviations;
}

Result<FitOptions> TrainByGradient(const std::vector<PendulumRecording>& recordings,
                                   const FitOptions& options, const FittedPhysics& physics,
                                   const SolveProgress& progress) {
  const FitProblem problem(recordings, physics.options);
  LargeNetworkFit fit;
  EarlyStoppingSplit split{std::vector<int>(recordings.size(), 1), {}};
  if (options.early_stopping > 0.0) {
    const auto made = SplitForEarlyStopping(problem, options.early_stopping, options.seed);
    if (!made.ok()) return made.error();
    split = made.value();
  }
  fit.training = Counted(problem, physics.point, split.training);
  fit.held_out = Counted(problem, physics.point, split.held_out);
  fit.model = options.model;
  fit.map = MapBesideNetwork(options, problem.Parameters(physics.point, ""));
  for (const FittedParameter& f : fit.map.fitted) {
    fit.shared.push_back(ToFitted(f.transform, options.table[f.parameter].nominal));
  }
  fit.shared_prior = SharedPriors(options.table, fit.map);
  fit.options.fit_shared = true;
  fit.sigmas = physics.options.sigmas;
  fit.options.weight_sigma = options.network_prior;
  fit.options.max_iterations = options.network_iterations;
  fit.options.optimizer = options.network_optimizer;
  fit.options.rate = options.network_rate;
  fit.options.seed = options.seed;
  const Result<LargeNetworkSolution> trained =
      FitLargeNetwork(fit, [&progress](const LargeNetworkIteration& i) {
        const std::string failing =
            i.training_failures > 0
                ? ", " + std::to_string(i.training_failures) + " rollouts leave the domain"
                : "";
        if (progress) progress("network by its gradient" + failing, i.iteration, i.cost);
        return true;
      });
  if (!trained.ok()) return trained.error();
  if (trained.value().training_failures == static_cast<int>(fit.training.size())) {
    return Error{
        "in the last pass of the training every rollout left the domain; lower "
        "--network_rate"};
  }

  FitOptions held = options;
  held.model.learned = trained.value().Network(*options.model.learned);
  held.hold_network = true;
  held.horizons = {0};
  const ParameterSet<double> learned =
      fit.map.Apply<double>(trained.value().shared.data(), nullptr);
  for (ParameterSpec& spec : held.table.specs) {
    spec.nominal = learned[spec.id];
    spec.pooling_sigma = physics.options.table[spec.id].pooling_sigma;
  }
  held.sigmas = physics.options.sigmas;
  held.start_deviations = DeviationsOf(physics.point, problem.map(), held.table.Map());
  held.effective_weight = physics.options.effective_weight;
  return held;
}

}  // namespace
}  // namespace pushid

// The linker keeps this object for the sake of the name (ident/CMakeLists.txt).
extern "C" {
bool pushid_large_networks = (pushid::LargeNetworkTraining() = pushid::TrainByGradient, true);
}
