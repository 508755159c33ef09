// ident: from a fit to a model that predicts.
#include "ident/model/identified_model.h"

#include <cmath>

#include "ident/model/fitted_model.h"

namespace pushid {

double StepProbability::At(double margin) const {
  return 1.0 / (1.0 + std::exp(-(coefficients[0] + coefficients[1] * margin)));
}

double StepProbability::ErrorAt(double margin) const {
  const double p = At(margin);
  const Eigen::Vector2d x(1.0, margin);
  return p * (1.0 - p) * std::sqrt(std::max(0.0, x.dot(covariance * x)));
}

IdentifiedModel ModelOf(const FitResult& result) {
  IdentifiedModel model;
  static_cast<ModelFacts&>(model) = result;
  model.options = result.options.model;
  model.table = result.options.table;
  model.pool_by = result.options.pool_by;
  const auto add = [&](const std::string& unit, const std::map<std::string, Estimate>& pooled) {
    if (pooled.empty()) return;
    ParameterSet<double>& own = model.by_unit[unit] = result.parameters;
    for (const auto& [name, estimate] : pooled) own[model.table.Find(name)->id] = estimate.value;
    model.table.SetTied(&own);
  };
  for (const auto& [id, subject] : result.subjects) add(id, subject.pooled);
  for (const auto& [setting, pooled] : result.settings) add(setting, pooled);
  return model;
}

MaybeError SetValues(const std::string& assignments, IdentifiedModel* model) {
  const Result<std::vector<NamedValue>> values = ParseAssignments(assignments, "--set");
  if (!values.ok()) return values.error();
  if (MaybeError error = CheckTouching(assignments, "--set", model->table, model->options)) {
    return error;
  }
  TableEdits edits;
  edits.set = assignments;
  if (MaybeError error = EditTable(edits, &model->table)) return error;
  for (const NamedValue& named : values.value()) {
    const Parameter id = model->table.Find(named.name)->id;
    if (!Acts(id, model->options)) {
      std::vector<std::string> acting;
      for (const ParameterSpec& spec : model->table.specs) {
        if (Acts(spec.id, model->options)) acting.push_back(spec.name);
      }
      return Error{"--set names " + named.name +
                   ", which does nothing in this model; what acts is " + ListOfNames(acting)};
    }
    const auto set = [&](ParameterSet<double>* own) {
      (*own)[id] = named.value;
      model->table.SetTied(own);
    };
    set(&model->parameters);
    for (auto& [unit, own] : model->by_unit) set(&own);
  }
  return std::nullopt;
}

}  // namespace pushid
