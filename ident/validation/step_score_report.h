// ident: how well it is predicted who steps, in words, as JSON and as a picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/step_score.h"
#include "ident/results/step_probability.h"

namespace pushid {

// "P(step) = ...", its errors, and at which margin half of all people step.
std::string StepProbabilityText(const StepProbability& probability);

// A column for each named score that is known.
using NamedStepScores = std::vector<std::pair<std::string, const StepScore*>>;
TextTable StepScoresTable(const NamedStepScores& scores);
// The same with what the errors are; empty where no score is known.
std::string StepScoresText(const NamedStepScores& scores);

// {tracks, stepped, people, brier, brier_error, auc, auc_error,
//  fifths: [{tracks, predicted, observed}, ...]}, and for models with step states
// lift_off: {people, median_error_s, mean_absolute_error_s}
nlohmann::ordered_json ToJson(const StepScore& score);
StepScore StepScoreFromJson(const nlohmann::ordered_json& json);

// The fifths' observed share over the predicted probability, beside the diagonal.
Chart ReliabilityChart(const StepScore& score);

}  // namespace pushid
