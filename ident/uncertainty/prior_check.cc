// ident: refits with other priors.
#include "ident/uncertainty/prior_check.h"

#include "ident/solver/solver.h"

namespace pushid {
namespace {

// Shared values on the fitted scale; empty where the refit fails.
std::vector<double> RefitWith(const FitProblem& problem, const FitPoint& estimate, double factor) {
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) {
    if (spec.prior) spec.prior = Prior{factor * spec.prior->mean, factor * spec.prior->sigma};
  }
  const FitProblem other(problem.recordings(), options, problem.counts());
  const SolveStart refit = Refit(other, estimate);
  return refit.failed.empty() ? refit.to.shared : std::vector<double>();
}

}  // namespace

std::vector<PriorCheckRow> CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                                       const Uncertainty& uncertainty) {
  const auto& fitted = problem.map().fitted;
  bool any = false;
  for (const FittedParameter& f : fitted) {
    any = any || problem.options().table[f.parameter].prior.has_value();
  }
  if (!any) return {};
  const std::vector<double> halved = RefitWith(problem, estimate, 0.5);
  const std::vector<double> doubled = RefitWith(problem, estimate, 2.0);
  if (halved.empty() || doubled.empty()) return {};
  std::vector<PriorCheckRow> rows;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const Estimate& e = uncertainty.estimates[i];
    PriorCheckRow row{e.name, e.unit};
    row.value = e.value;
    row.halved = ToNatural(fitted[i].transform, halved[i]);
    row.doubled = ToNatural(fitted[i].transform, doubled[i]);
    for (double value : {row.halved, row.doubled}) {
      row.inside = row.inside && e.lower95 <= value && value <= e.upper95;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace pushid
