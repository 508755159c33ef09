// ident: a fit's result as JSON, without loss: every number reads back the same, infinities as the
// string "infinity". Reports and predictions are functions of this file alone.
#pragma once

#include <nlohmann/json.hpp>

#include "ident/parameters/own_laws.h"
#include "ident/results/fit_result.h"

namespace pushid {

inline constexpr int kModelFormat = 1;  // raised when older readers would misread a file

// What changes from run to run and stands under `run`.
struct RunInfo {
  std::string date, host, model_path;
  double total_seconds = 0.0;
  int num_threads = 1;
};

nlohmann::ordered_json ToJson(const FitResult& result, const RunInfo& run);

// The options and the table: everything that decides what a fit of given recordings finds.
nlohmann::ordered_json SettingsJson(const FitOptions& options);

// Errors: not a pushid model, a newer format, missing or wrong entries by name.
// laws: those of the caller's own that the model may have been fitted with; one that the file names
// and that is not here is an error.
Result<FitResult> FitResultFromJson(const nlohmann::ordered_json& json, const std::string& file,
                                    const ForceLaws& laws = {});
Result<FitResult> ReadFitResult(const std::string& path, const ForceLaws& laws = {});

nlohmann::ordered_json ToJson(const Behaviour& behaviour);

}  // namespace pushid
