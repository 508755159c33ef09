// ident: options of several names at once, for flags and JSON alike. Those of one name are read by
// ParseName (datasets/files/names.h).
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "models/options.h"

namespace pushid {

// Interaction terms: comma-separated pieces; "contact" is short for spring and damping.
std::string NameOf(const InteractionTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms);

// The words of --covariate.

// The covariates of one parameter.
struct CovariatesOfParameter {
  std::string parameter;
  std::vector<std::string> keys;
};

// "Kp_theta ~ age + height; Kd_theta ~ age". Errors: a part without '~' or without a name on
// either side, the same covariate of a parameter twice.
Result<std::vector<CovariatesOfParameter>> ParseCovariates(const std::string& text);

}  // namespace pushid
