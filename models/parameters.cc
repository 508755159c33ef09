#include "models/parameters.h"

#include "models/force_law.h"
#include "models/learned_terms.h"

namespace pushid {

bool Acts(Parameter id, const ModelOptions& model) {
  if (id >= kFirstOwnParameter) return id < kFirstOwnParameter + NumOwnParameters(model);
  return kParameterRows[id].acts(model);
}

bool FreedByItsTerm(Parameter id, const ModelOptions& model) {
  if (id >= kFirstOwnParameter || kParameterRows[id].freed == nullptr) return false;
  return kParameterRows[id].freed(model);
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
