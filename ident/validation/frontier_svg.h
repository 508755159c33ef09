// ident: accuracy against settling: what a configuration predicts, and whether its people stand
// again.
#pragma once

#include <string>
#include <vector>

#include "ident/validation/crossvalidation.h"

namespace pushid {

// One point for every predictor that was fitted: across, the fastest anybody in the settling
// simulations of any fold still is two seconds after a push (up to 0.1 m/s counts as settled); up,
// hipADE with its standard error.
std::string FrontierSvg(const std::vector<CrossValidation>& validations);

}  // namespace pushid
