// ident: what is added to a finished fit.
#include "ident/results/confidence.h"

#include "ident/problem/fit_problem.h"

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

}  // namespace pushid
