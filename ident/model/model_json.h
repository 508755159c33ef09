// ident: a fitted model as JSON, without loss: every number reads back the same, infinities as the
// string "infinity". Reports and predictions are functions of this file alone.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ident/model/fitted_model.h"

namespace pushid {

inline constexpr int kModelFormat = 1;  // raised when older readers would misread a file

// Facts that change from run to run and stand under `run`.
struct RunInfo {
  std::string date, host, model_path;
  double total_seconds = 0.0;
  int num_threads = 1;
};

nlohmann::ordered_json ToJson(const FittedModel& model, const RunInfo& run);

// Writes the file of a run that ends now, on this host, after so many seconds.
MaybeError WriteFittedModel(const std::string& path, const FittedModel& model, int num_threads,
                            double total_seconds);

// Errors: not a pushid model, a newer format, missing or wrong entries by name, with the version
// that wrote them where it is another one. laws: those of the caller's own that the model may have
// been fitted with; one that the file names and that is not here is an error.
Result<FittedModel> FittedModelFromJson(const nlohmann::ordered_json& json, const std::string& file,
                                        const ForceLaws& laws = {});
Result<FittedModel> ReadFittedModel(const std::string& path, const ForceLaws& laws = {});

nlohmann::ordered_json ToJson(const Behaviour& behaviour);

}  // namespace pushid
