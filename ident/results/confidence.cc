// ident: what is added to a finished fit.
#include "ident/results/confidence.h"

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/horizon_check.h"

namespace pushid {

MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  Result<std::vector<Profile>> profiles =
      ComputeProfiles(problem, model->fit.starts[model->fit.best_start].to, model->fit.uncertainty,
                      names, num_threads, progress);
  if (!profiles.ok()) return profiles.error();
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

void AddHorizonCheck(const std::vector<PendulumRecording>& recordings, int num_threads,
                     const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  model->horizon_check = CheckHorizons(problem, model->fit.starts[model->fit.best_start].to,
                                       model->fit.uncertainty, num_threads, progress);
}

}  // namespace pushid
