// ident: evaluations, cross-validations and propagation as JSON, whose keys carry their units, and
// as text and tables for a terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {

// The means of the model and the baselines, by strength, or by the first label if there is no
// strength.
Screen EvaluationScreen(const Evaluation& evaluation);
std::string EvaluationText(const Evaluation& evaluation, bool per_recording);
std::string PropagationText(const NamedValues<PropagationSummary>& summaries);
// A sentence about how pushes travel through groups, measured and predicted; empty without any.
std::string TravelText(const PropagationSummary& propagation);

// The predictors, and whether the first differs from the best of the others.
Screen CrossValidationScreen(const std::vector<CrossValidation>& candidates);
std::string CrossValidationText(const std::vector<CrossValidation>& candidates);

inline constexpr char kScoresSchema[] = "pushid-scores/1";  // of --json_out

nlohmann::ordered_json ToJson(const Evaluation& evaluation);
nlohmann::ordered_json ToJson(const ScoreSummary& summary, bool with_recordings);
nlohmann::ordered_json ToJson(const CrossValidation& validation);
nlohmann::ordered_json ToJson(const PairedDifference& difference);

// A row of a table of recordings: id, frames, and the metrics or the failure.
nlohmann::ordered_json ScoreJson(const Score& score, const MetricList& metrics);
// Adds `mean`, `by_KEY` and `without_label`. with_clusters: each says by what its
// errors are clustered.
void AddMeans(const ScoreMeans& means, const MetricList& metrics, bool with_clusters,
              nlohmann::ordered_json* json);

// The means over recordings in a file of scores, of hips or of bodies. Errors: keys that are
// missing or of another type.
Result<Metrics> MeanMetrics(const nlohmann::ordered_json& json, const MetricList& metrics,
                            const std::string& file);

// The mean of the scores of several samples of one forecast, each scored by itself, as SDM does.
// An entry that is null in one sample is null; an entry that is no number is that of the first
// sample.
nlohmann::ordered_json MeanOfSamples(const std::vector<nlohmann::ordered_json>& samples);

}  // namespace pushid
