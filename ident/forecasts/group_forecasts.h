// ident: groups forecast: whether what they did lies among their sampled futures, and what they do
// when they are forecast for long.
//
//   inside  share of people's frames after those seen in which the recorded hip's x lies between
//           the smallest and the largest of n samples; (n - 1) / (n + 1) where they are drawn as
//           the truth is
//   width   between those two, m
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ident/generators/push_particles.h"
#include "ident/validation/group_metrics.h"

namespace pushid {

struct GroupSpread {
  int samples = 0;
  double frames = 0.0, inside_sum = 0.0, width_sum = 0.0;

  double Inside() const { return inside_sum / std::max(1.0, frames); }
  double Width() const { return width_sum / std::max(1.0, frames); }
};

// Adds a recording of which the first `observed` frames are seen; hips: of physics, or none.
void AddSpread(const MotionGenerator& generator, const BodyRecording& recording,
               const GroupHips& hips, int observed, const NormalSource& normal,
               GroupSpread* spread);

nlohmann::ordered_json ToJson(const GroupSpread& spread);
std::string SpreadText(const GroupSpread& spread);

// What groups do when they are forecast for longer than anybody was recorded: whether they
// come to rest, and how unlike the recorded motion what they do becomes (SSCP over time, as in
// SDM).

// One second of the forecasts.
struct ForecastSecond {
  double hip_speed = 0.0;          // mean, horizontal, m/s
  double hip_way = 0.0;            // mean distance from the last shown frame at its end, m
  std::optional<double> standing;  // share of people and frames that neither lean, step nor push
  std::optional<double> sscp;      // of its states to all that were recorded
};

// Whole seconds alone, from the last frame on that the forecast was shown.
std::vector<ForecastSecond> BySecond(const std::vector<GroupMotion>& recorded,
                                     const std::vector<GroupMotion>& forecast,
                                     const StateFunction& states = SocialStateFunction());

nlohmann::ordered_json ToJson(const std::vector<ForecastSecond>& seconds);
// A table under the name of what forecasts.
std::string SecondsText(const std::string& name, const std::vector<ForecastSecond>& seconds);

}  // namespace pushid
