// models: what is known of a parameter before any fit (model_rows.h).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "models/options.h"
#include "models/parameters.h"
#include "models/transform.h"

namespace pushid {

// Also how a user's own force law describes its parameters (force_law.h).
struct ParameterFacts {
  std::string_view name;
  std::string_view symbol;
  std::string_view unit;
  double nominal = 0.0;  // start of a fit, value when fixed
  double lower = 0.0, upper = 0.0;
  double scale = 1.0;  // a typical size, for scaling null directions and judging "weak"
  Transform transform = Transform::kIdentity;
  std::string_view meaning = {};       // one line for people
  std::string_view when_to_free = {};  // another
};

// What makes a row unfit for a fit, as in "must start within its bounds"; empty: nothing.
std::string Violation(const ParameterFacts& facts);

// In the order of Parameter.
const std::array<ParameterFacts, kFirstOwnParameter>& AllParameterFacts();

// Whether a parameter has any effect in a model; one of a user's own where some law claims it.
bool Acts(Parameter id, const ModelOptions& model);

// Whether choosing a term that the model has frees the parameter.
bool FreedByItsTerm(Parameter id, const ModelOptions& model);

}  // namespace pushid
