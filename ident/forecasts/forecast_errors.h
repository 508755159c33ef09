// ident: how far forecasts are from what was recorded, by action and horizon.
//
// MPJPE: mean distance of joints, all 38 of CMU's, where joints that share a place count with it
// and those that never move are right. The mean over all is that of the actions' means.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/loading/forecast_windows.h"

namespace pushid {

using HorizonErrors = std::array<double, kHorizonFrames.size()>;  // m

struct ActionErrors {
  int windows = 0;
  HorizonErrors mpjpe{};
};

struct ForecastErrors {
  std::map<std::string, ActionErrors> actions;
  ActionErrors mean;  // of the actions
};

// forecasts: one per window.
ForecastErrors ErrorsOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<Trajectories>& forecasts, const ParticleLayout& layout);

// The last observed pose, held.
std::vector<Trajectories> ZeroVelocity(const std::vector<ForecastWindow>& windows);

// {"mean": {"MPJPE_mm": {"80": ...}}, "actions": {"walking": {"windows": 8, "MPJPE_mm": {...}}}}
nlohmann::ordered_json ToJson(const ForecastErrors& errors);
// "walking  9.1  18.8 ..." a line an action, with a head and the mean.
std::string ForecastErrorsText(const ForecastErrors& errors);

}  // namespace pushid
