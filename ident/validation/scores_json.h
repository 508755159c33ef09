// ident: evaluations, cross-validations and propagation to JSON, and scores back from it. Keys
// carry their units.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ident/validation/crossvalidation.h"

namespace pushid {

nlohmann::ordered_json ToJson(const Evaluation& evaluation);
nlohmann::ordered_json ToJson(const ScoreSummary& summary, bool with_recordings);
nlohmann::ordered_json ToJson(const PropagationSummary& summary);
nlohmann::ordered_json PeopleJson(const PropagationScore& score);  // one row per person
nlohmann::ordered_json ToJson(const CrossValidation& validation);
nlohmann::ordered_json ToJson(const PairedDifference& difference);

// The model's scores of an Evaluation's JSON (or of one summary with its recordings), without each
// person's propagation. Errors: keys that are missing or of another type.
Result<ScoreSummary> ScoresFromJson(const nlohmann::ordered_json& json, const std::string& file);
Result<ScoreSummary> ReadScores(const std::string& path);

}  // namespace pushid
