// ident: evaluations, cross-validations and propagation as JSON. Keys carry their units.
#pragma once

#include <nlohmann/json.hpp>

#include "ident/validation/crossvalidation.h"

namespace pushid {

nlohmann::ordered_json ToJson(const Evaluation& evaluation);
nlohmann::ordered_json ToJson(const ScoreSummary& summary, bool with_recordings);
nlohmann::ordered_json ToJson(const PropagationSummary& summary);
nlohmann::ordered_json PeopleJson(const PropagationScore& score);  // one row per person
nlohmann::ordered_json ToJson(const CrossValidation& validation);
nlohmann::ordered_json ToJson(const PairedDifference& difference);

}  // namespace pushid
