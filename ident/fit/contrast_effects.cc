// ident: the spread between people that a contrast is measured by.
#include <map>

#include "ident/fit/covariates.h"
#include "ident/fit/weighted_solve.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

// Whether people can be told from their recordings.
bool PeopleCanBeTold(const std::vector<PendulumRecording>& recordings) {
  std::map<std::string, int> times;
  for (const PendulumRecording& recording : recordings) {
    for (const std::string& id : recording.subject_ids) ++times[id];
  }
  bool repeated = false;
  for (const auto& [id, number] : times) repeated = repeated || number > 1;
  return repeated && static_cast<int>(times.size()) >= kFewestPeople;
}

// The same fit from its own optimum, in which people differ in what is compared.
FitOptions WithPeopleApart(const FitResult& result) {
  FitOptions options = result.options;
  options.pool_by = kSubjectUnit;
  options.pooling_sigma.reset();
  options.start_deviations.clear();
  options.hold_network = true;
  options.horizons = {0};
  for (ParameterSpec& spec : options.table.specs) {
    if (spec.free) spec.nominal = result.parameters[spec.id];
    spec.pooled = false;
    spec.pooling_sigma = kFirstPoolingSigma;
  }
  for (const ContrastRow& row : result.contrast->rows) {
    ParameterSpec* spec = options.table.Find(row.name);
    spec->pooled = spec->free && !IsPairParameter(spec->id);
  }
  return options;
}

}  // namespace

void AddContrastEffects(const std::vector<PendulumRecording>& recordings, FitResult* result) {
  if (!result->contrast) return;
  const FitOptions& fitted = result->options;
  const bool by_person = AnyPooled(fitted.table) && fitted.pool_by == kSubjectUnit;
  if (by_person || !PeopleCanBeTold(recordings)) return;
  FitProblem problem(recordings, WithPeopleApart(*result));
  const WeightedSolution solved = SolveFit(&problem);
  if (!solved.solution.ok()) return;
  for (ContrastRow& row : result->contrast->rows) {
    const ParameterSpec* spec = problem.options().table.Find(row.name);
    if (!spec->pooled || spec->pooling_sigma <= kLeastPoolingSigma) continue;
    const ParameterSpec* slope = fitted.table.Find(row.name + "~" + result->contrast->label);
    row.effect = result->parameters[slope->id] / PoolingSigma(*spec);
  }
}

}  // namespace pushid
