// ident: a fit as folds need it.
#include "ident/fit/fit.h"
#include "ident/fit/step_probability.h"
#include "ident/fit/weighted_solve.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/likelihood_solve.h"

namespace pushid {

Result<SolvedModel> SolveModel(const std::vector<PendulumRecording>& recordings,
                               FitOptions options) {
  if (MaybeError error = PrepareFit(recordings, &options)) return *error;
  const FitOptions prepared = options;
  const Result<FitOptions> trained = WithLargeNetworkTrained(recordings, prepared);
  if (!trained.ok()) return trained.error();
  options = trained.value();
  const Solution solution = SolveAsAsked(recordings, &options).solution;
  if (solution.best >= 0) EstimateNoise(recordings, solution.Best().to, &options);
  const FitProblem problem(recordings, options);
  if (solution.best < 0) return Error{"no usable optimum was found"};
  const FitPoint& best = solution.Best().to;
  SolvedModel solved;
  IdentifiedModel& model = solved.model;
  model.options = problem.ModelAt(best);
  model.mapping = options.mapping;
  model.table = options.table;
  model.parameters = problem.Parameters(best, "");
  model.pool_by = options.pool_by;
  for (const auto& [unit, deviations] : best.unit) {
    model.by_unit[unit] = problem.Parameters(best, unit);
  }
  if (options.ensemble > 1) model.others = FitOtherSeeds(recordings, prepared);
  model.step_probability = FitStepProbability(model, recordings);
  solved.behaviour = problem.BehaviourAt(best);
  return solved;
}

}  // namespace pushid
