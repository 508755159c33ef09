// ident: scores of bodies as JSON and as tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ident/bodies/body_evaluation.h"

namespace pushid {

// Adds the body's keys (MPJPE_m, MBLE_m, ...) to an evaluation's JSON (model_json.h): to the
// means, groups and recordings at the top (of the restoration, or of the generator), to
// baselines.static and baselines.constant_velocity, and as new entries baselines.rigid (and
// peers'), true_pendulum and recorded.
void AddBodyJson(const BodyEvaluation& evaluation, nlohmann::ordered_json* json);

// The means over recordings of what AddBodyJson added to. file: where it stands, for errors.
Result<BodyMetrics> MeanBodyMetrics(const nlohmann::ordered_json& json, const std::string& file);

nlohmann::ordered_json MeanJson(const BodyMean& mean);
nlohmann::ordered_json ToJson(const BodySummary& summary, bool with_recordings);

// A row per predictor, a column per metric; then the restoration by label.
std::string BodyText(const BodyEvaluation& evaluation);

}  // namespace pushid
