// ident: what is added to a finished fit.
#include "ident/results/confidence.h"

#include "ident/problem/fit_problem.h"

namespace pushid {
MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FitResult* result) {
  const FitProblem problem(recordings, result->options);
  Result<std::vector<Profile>> profiles =
      ComputeProfiles(problem, result->starts[result->best_start].to, result->uncertainty, names,
                      num_threads, progress);
  if (!profiles.ok()) return profiles.error();
  result->profiles = std::move(profiles.value());
  return std::nullopt;
}

MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FitResult* result) {
  const FitProblem problem(recordings, result->options);
  Result<Bootstrap> bootstrap =
      ComputeBootstrap(problem, result->starts[result->best_start].to, options, progress);
  if (!bootstrap.ok()) return bootstrap.error();
  result->bootstrap = std::move(bootstrap.value());
  return std::nullopt;
}

}  // namespace pushid
