// ident: adding force laws by hand and by name.
#include "ident/parameters/own_laws.h"

#include <algorithm>

namespace pushid {

MaybeError AddForceLaw(std::shared_ptr<const ForceLaw> law, ModelOptions* model,
                       ParameterTable* table) {
  const std::string who = "force law '" + law->name() + "'";
  for (const std::string& name : LawNames(*model)) {
    if (name == law->name()) return Error{who + ": the model has one of that name; rename it"};
  }
  if (std::any_of(table->specs.begin(), table->specs.end(),
                  [](const ParameterSpec& spec) { return spec.slope_of.has_value(); })) {
    return Error{who + ": add force laws before the fit is prepared, which adds covariates"};
  }
  const int free_slots = kNumOwnParameters - NumOwnParameters(*model);
  const int wanted = static_cast<int>(law->parameters().size());
  if (wanted > free_slots) {
    return Error{
        who + " has " + std::to_string(wanted) + " parameters; there is room for " +
        std::to_string(free_slots) +
        " (kNumOwnParameters in models/parameters.h is the room for all laws and covariates)"};
  }
  ParameterTable with = *table;
  for (const ParameterFacts& facts : law->parameters()) {
    if (with.Find(std::string(facts.name)) != nullptr) {
      return Error{who + ": there is a parameter '" + std::string(facts.name) +
                   "' already; rename the law's"};
    }
    if (const std::string violated = Violation(facts); !violated.empty()) {
      return Error{who + ": its parameter '" + std::string(facts.name) + "' " + violated};
    }
    with.Add(facts).free = true;
  }
  *table = std::move(with);
  model->own_laws.push_back(std::move(law));
  return {};
}

MaybeError AddNamedLaws(const std::vector<std::string>& names, const ForceLaws& laws,
                        ModelOptions* model, ParameterTable* table) {
  for (const std::string& name : names) {
    const auto found = std::find_if(laws.begin(), laws.end(),
                                    [&name](const auto& law) { return law->name() == name; });
    if (found == laws.end()) {
      return Error{"the model was fitted with the force law '" + name +
                   "', which is not part of pushid; read it with a program that has that law and "
                   "gives it to ReadFittedModel"};
    }
    if (MaybeError error = AddForceLaw(*found, model, table)) return error;
  }
  return {};
}

std::vector<std::string> LawNames(const ModelOptions& model) {
  std::vector<std::string> names;
  for (const auto& law : model.own_laws) names.push_back(law->name());
  return names;
}

}  // namespace pushid
