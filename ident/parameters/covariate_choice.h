// ident: the words of --covariate.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// The covariates of one parameter.
struct CovariatesOfParameter {
  std::string parameter;
  std::vector<std::string> keys;
};

// "Kp_theta ~ age + height; Kd_theta ~ age". Errors: a part without '~' or without a name on
// either side, the same covariate of a parameter twice.
Result<std::vector<CovariatesOfParameter>> ParseCovariates(const std::string& text);

}  // namespace pushid
