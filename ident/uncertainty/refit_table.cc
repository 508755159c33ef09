// ident: what refits are compared with.
#include "ident/uncertainty/refit_table.h"

#include "ident/problem/fit_problem.h"
#include "ident/solver/solution.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

std::vector<double> SharedValues(const FitProblem& problem, const FitPoint& point) {
  const ParameterSet<double> parameters = problem.Parameters(point, "");
  std::vector<double> values;
  for (const FittedParameter& f : problem.map().fitted) values.push_back(parameters[f.parameter]);
  return values;
}

void Take(const FitProblem& problem, const SolveStart& refit, RefitRow* row) {
  if (!refit.usable && refit.failed.empty()) {
    row->failure = "the refit did not converge: " + refit.message;
  } else if (!refit.failed.empty()) {
    row->failure = "some rollouts leave the model's domain";
  } else {
    row->value = SharedValues(problem, refit.to);
  }
}

RefitTable RefitTableOf(const FitProblem& problem, const FitPoint& estimate,
                        const Uncertainty& uncertainty) {
  RefitTable table;
  table.value = SharedValues(problem, estimate);
  for (size_t i = 0; i < table.value.size(); ++i) {
    table.parameters.push_back(uncertainty.estimates[i].name);
    table.units.push_back(uncertainty.estimates[i].unit);
    table.standard_error.push_back(uncertainty.estimates[i].standard_error);
  }
  return table;
}

}  // namespace pushid
