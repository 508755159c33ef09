// ident: the probability of a step in a model's file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ident/fit/step_probability.h"

namespace pushid {

nlohmann::ordered_json ToJson(const StepProbability& probability);
// Throws what nlohmann's JSON throws, and std::runtime_error for what cannot be.
StepProbability StepProbabilityFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
