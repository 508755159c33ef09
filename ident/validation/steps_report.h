// ident: the steps that people took in recordings, in words and as JSON, beside how well a model
// predicts them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {

// "steps: 217 of 255 people step; medians: first lift-off after 0.5 s, first step 0.41 m"; before
// it, if asked, a line for each person.
std::string StepsReport(const std::vector<PendulumRecording>& recordings, bool per_recording);

// Adds to each entry of `recordings` in an evaluation's JSON (same order):
//   steps: one list a person: [{foot, lift_off_s, landing_s, length_m, direction_deg}, ...]
// landing_s is null where the recording ends first, and length_m then how far the foot came;
// direction_deg is 0 forwards and 90 to the left. And at the top:
//   steps: {people, people_who_step, first_lift_off_median_s, first_length_median_m}
void AddStepsJson(const std::vector<PendulumRecording>& recordings, nlohmann::ordered_json* json);

// "P(step) = ...", its errors, and at which margin half of all people step.
std::string StepProbabilityText(const StepProbability& probability);

// A column for each named score that is known.
using NamedStepScores = std::vector<std::pair<std::string, const StepScore*>>;
TextTable StepScoresTable(const NamedStepScores& scores);
// The table with what the errors are; empty where no score is known.
std::string StepScoresText(const NamedStepScores& scores);

// The fifths' observed share over the predicted probability, beside the diagonal.
Chart ReliabilityChart(const StepScore& score);

}  // namespace pushid
