// ident: evaluations, cross-validations and propagation as JSON. Keys carry their units.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ident/validation/crossvalidation.h"

namespace pushid {

inline constexpr char kScoresSchema[] = "pushid-scores/1";  // of --json_out

nlohmann::ordered_json ToJson(const Evaluation& evaluation);
nlohmann::ordered_json ToJson(const ScoreSummary& summary, bool with_recordings);
nlohmann::ordered_json ToJson(const CrossValidation& validation);
nlohmann::ordered_json ToJson(const PairedDifference& difference);

// A row of a table of recordings: id, frames, and the metrics or the failure.
nlohmann::ordered_json ScoreJson(const Score& score, const MetricList& metrics);
// Adds `mean`, `frame_weighted`, `by_KEY` and `without_label`. with_clusters: each says by what its
// errors are clustered.
void AddMeans(const ScoreMeans& means, const MetricList& metrics, bool with_clusters,
              nlohmann::ordered_json* json);

// The means over recordings in a file of scores, of hips or of bodies. Errors: keys that are
// missing or of another type.
Result<Metrics> MeanMetrics(const nlohmann::ordered_json& json, const MetricList& metrics,
                            const std::string& file);

// Several samples of one forecast, each scored by itself, as SDM has it: the means of all numbers.
// Whatever has no value in one of them has none; what is no number is the first's.
nlohmann::ordered_json MeanOfSamples(const std::vector<nlohmann::ordered_json>& samples);

// "single_X05_00 (fell at 0.4 s)" of each recording without a prediction.
std::vector<std::string> FailedRecordings(const ScoreSummary& summary);
// The mean over all recordings, with the error of standing still where there is no prediction.
Metrics MeanWithStatic(const ScoreSummary& summary);

}  // namespace pushid
