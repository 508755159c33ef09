// models: the parameters' facts, from their rows.
#include "models/parameters.h"

#include "models/force_law.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

using Predicate = bool (*)(const ModelOptions&);

}  // namespace

const std::array<ParameterFacts, kFirstOwnParameter>& AllParameterFacts() {
  static const std::array<ParameterFacts, kFirstOwnParameter> facts = {{
#define PUSHID_PARAMETER(id, name, symbol, unit, nominal, lower, upper, scale, transform, acts, \
                         freed, meaning, when)                                                  \
  {name, symbol, unit, nominal, lower, upper, scale, Transform::transform, meaning, when},
      PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
  }};
  return facts;
}

bool Acts(Parameter id, const ModelOptions& model) {
  static constexpr Predicate kActs[] = {
#define PUSHID_PARAMETER(id, name, symbol, unit, nominal, lower, upper, scale, transform, acts, \
                         ...)                                                                   \
  []([[maybe_unused]] const ModelOptions& m) { return acts; },
      PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
  };
  if (id >= kFirstOwnParameter) return id < kFirstOwnParameter + NumOwnParameters(model);
  return kActs[id](model);
}

bool FreedByItsTerm(Parameter id, const ModelOptions& model) {
  static constexpr Predicate kFreed[] = {
#define PUSHID_PARAMETER(id, name, symbol, unit, nominal, lower, upper, scale, transform, acts, \
                         freed, ...)                                                            \
  []([[maybe_unused]] const ModelOptions& m) { return freed; },
      PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
  };
  return id < kFirstOwnParameter && kFreed[id](model);
}

std::string Violation(const ParameterFacts& facts) {
  if (facts.name.empty() || facts.unit.empty()) return "must have a name and a unit";
  if (!(facts.lower < facts.upper)) return "must have a lower bound below its upper one";
  if (!(facts.lower <= facts.nominal && facts.nominal <= facts.upper)) {
    return "must start within its bounds";
  }
  if (!(facts.scale > 0.0)) return "must have a positive scale";
  if (facts.transform == Transform::kLog && !(facts.lower > 0.0)) {
    return "must have a positive lower bound: it is fitted as a logarithm";
  }
  if (facts.transform == Transform::kLogit && !(facts.lower > 0.0 && facts.upper < 1.0)) {
    return "must have bounds between 0 and 1: it is fitted as a logit";
  }
  return "";
}

}  // namespace pushid
