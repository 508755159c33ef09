// ident: what is added to a finished fit.
#include "ident/fit/confidence.h"

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/horizon_check.h"
#include "ident/uncertainty/prior_check.h"

namespace pushid {
namespace {

// The fit without what was put in beside its recordings, by the same weights.
FitOptions OfDataAlone(FitOptions options) {
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = options.mode_weight = options.stability_weight = 0.0;
  return options;
}

void ClassifyByDataAlone(const FitProblem& with, const FitPoint& estimate,
                         const std::vector<std::string>& names, int num_threads,
                         const JobProgress& progress, std::vector<Profile>* profiles) {
  const FitOptions options = OfDataAlone(with.options());
  const FitProblem alone(with.recordings(), options);
  if (CostAt(alone, estimate) == CostAt(with, estimate)) return;  // nothing was put in
  const SolveStart refit = Refit(alone, estimate);
  if (!refit.usable) return;
  const auto found = ClassifyProfiles(alone, refit.to, ComputeUncertainty(alone, refit.to), names,
                                      num_threads, progress);
  if (!found.ok()) return;
  for (size_t i = 0; i < profiles->size(); ++i) (*profiles)[i].by_data_alone = found.value()[i];
}

}  // namespace

MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  Result<std::vector<Profile>> profiles =
      ComputeProfiles(problem, model->fit.starts[model->fit.best_start].to, model->fit.uncertainty,
                      names, num_threads, progress);
  if (!profiles.ok()) return profiles.error();
  ClassifyByDataAlone(problem, model->fit.starts[model->fit.best_start].to, names, num_threads,
                      progress, &profiles.value());
  model->profiles = std::move(profiles.value());
  return std::nullopt;
}

MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  Result<Bootstrap> bootstrap =
      ComputeBootstrap(problem, model->fit.starts[model->fit.best_start].to, options, progress);
  if (!bootstrap.ok()) return bootstrap.error();
  model->bootstrap = std::move(bootstrap.value());
  return std::nullopt;
}

void AddPriorCheck(const std::vector<PendulumRecording>& recordings, FittedModel* model) {
  FitResult& fit = model->fit;
  const FitProblem problem(recordings, fit.options);
  model->prior_check = CheckPriors(problem, fit.starts[fit.best_start].to, fit.uncertainty);
  const RefitTable& check = *model->prior_check;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    Estimate& known = fit.uncertainty.estimates[i];
    if (known.status != EstimateStatus::kIdentified) continue;
    if (PriorsLeaveInside(check, i, fit.uncertainty)) continue;
    known.status = EstimateStatus::kWeak;
    for (Estimate& e : fit.estimates) {
      if (e.name == known.name) e.status = EstimateStatus::kWeak;
    }
  }
}

void AddHorizonCheck(const std::vector<PendulumRecording>& recordings, int num_threads,
                     const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  model->horizon_check = CheckHorizons(problem, model->fit.starts[model->fit.best_start].to,
                                       model->fit.uncertainty, num_threads, progress);
}

}  // namespace pushid
