// ident: refits with other priors.
#include "ident/uncertainty/prior_check.h"

#include <algorithm>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {
namespace {

RefitRow RefitWith(const FitProblem& problem, const FitPoint& estimate, const std::string& name,
                   double factor) {
  RefitRow row{"priors", name, {}, {}, "", 0};
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) {
    if (spec.prior) spec.prior = Prior{factor * spec.prior->mean, factor * spec.prior->sigma};
  }
  const FitProblem other(problem.recordings(), options, problem.counts());
  Take(other, Refit(other, estimate), &row);
  return row;
}

}  // namespace

RefitTable CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                       const Uncertainty& uncertainty) {
  RefitTable table = RefitTableOf(problem, estimate, uncertainty);
  const auto& fitted = problem.map().fitted;
  const bool any = std::any_of(fitted.begin(), fitted.end(), [&problem](const FittedParameter& f) {
    return problem.options().table[f.parameter].prior.has_value();
  });
  if (!any) return table;
  table.rows = {RefitWith(problem, estimate, "halved", 0.5),
                RefitWith(problem, estimate, "doubled", 2.0)};
  return table;
}

bool PriorsLeaveInside(const RefitTable& check, size_t index, const Uncertainty& uncertainty) {
  const Estimate& e = uncertainty.estimates[index];
  return std::all_of(check.rows.begin(), check.rows.end(), [&](const RefitRow& row) {
    return !row.value.empty() && e.lower95 <= row.value[index] && row.value[index] <= e.upper95;
  });
}

}  // namespace pushid
