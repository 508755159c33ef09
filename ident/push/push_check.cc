// ident: one refit for each variant of the pushes.
#include "ident/push/push_check.h"

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

RefitRow FitVariant(const PushVariant& variant, const FitOptions& options,
                    const FitPoint& estimate) {
  RefitRow row{variant.source, variant.name, {}, {}, "", 0};
  const FitProblem problem(variant.recordings, options);
  SolveStart fit = Refit(problem, estimate);
  // Far off, it is fitted like any other study.
  if (!fit.usable || !fit.converged) {
    fit = SolveFrom(problem, problem.NominalPoint(), "nominal", "", nullptr);
  }
  Take(problem, fit, &row);
  return row;
}

}  // namespace

MaybeError AddPushCheck(const std::vector<PendulumRecording>& recordings,
                        const PushVariantOptions& options, int num_threads,
                        const JobProgress& progress, FittedModel* model) {
  const Result<std::vector<PushVariant>> variants = PushVariants(recordings, options);
  if (!variants.ok()) return variants.error();
  const FitPoint& estimate = model->fit.starts[model->fit.best_start].to;
  FitOptions one = model->fit.options;
  one.num_threads = 1;
  RefitTable check = RefitTableOf(FitProblem(recordings, one), estimate, model->fit.uncertainty);
  check.rows.resize(variants.value().size());
  ParallelFor(
      static_cast<int>(check.rows.size()), num_threads,
      [&](int i) { check.rows[i] = FitVariant(variants.value()[i], one, estimate); }, progress);
  model->push_check = std::move(check);
  return std::nullopt;
}

}  // namespace pushid
