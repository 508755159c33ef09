// ident: what groups do when they are forecast for longer than anybody was recorded: whether they
// come to rest, and how unlike the recorded motion what they do becomes (SSCP over time, as in
// SDM).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ident/validation/group_metrics.h"

namespace pushid {

// One second of the forecasts.
struct ForecastSecond {
  double hip_speed = 0.0;      // mean, horizontal, m/s
  double hip_way = 0.0;        // mean distance from frame 0 at its end, m
  double standing = 0.0;       // share of people and frames that neither lean, step nor push
  std::optional<double> sscp;  // of its states to all that were recorded
};

// Whole seconds alone.
std::vector<ForecastSecond> BySecond(const std::vector<GroupMotion>& recorded,
                                     const std::vector<GroupMotion>& forecast);

nlohmann::ordered_json ToJson(const std::vector<ForecastSecond>& seconds);
// A table under the name of what forecasts.
std::string SecondsText(const std::string& name, const std::vector<ForecastSecond>& seconds);

}  // namespace pushid
