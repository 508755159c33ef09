// ident: the steps that people took in recordings, in words and as JSON, beside how well a model
// predicts them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"

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

}  // namespace pushid
