// models: the parameters' facts, from their rows.
#include "models/parameter_facts.h"

#include "models/force_law.h"
#include "models/self_network.h"

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

}  // namespace pushid
