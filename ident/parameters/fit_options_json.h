// ident: what a fit was asked for, as JSON: its options and its parameter table.
#pragma once

#include <nlohmann/json.hpp>

#include "ident/parameters/fit_options.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

nlohmann::ordered_json OptionsJson(const FitOptions& options);
nlohmann::ordered_json TableJson(const ParameterTable& table);
// A user's own laws are named ("force_laws"), so that a reader knows what to ask for; they cannot
// be written.
void AddLawNames(const ModelOptions& model, nlohmann::ordered_json* json);
// All three: everything that decides what a fit of given recordings finds.
nlohmann::ordered_json SettingsJson(const FitOptions& options);

// Throw what nlohmann's JSON throws for what is missing or of another type, and std::runtime_error
// for unknown names. What was learned is not in them (learned_terms_io.h).
FitOptions OptionsFrom(const nlohmann::ordered_json& json);
// known: every parameter there is; those that the JSON does not name stay.
ParameterTable TableFrom(const nlohmann::ordered_json& json, const ParameterTable& known);

}  // namespace pushid
