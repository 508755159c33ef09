// ident: how well sampled futures spread, by horizon.
//
//   coverage      share of coordinates whose truth lies in the central 90 % of the samples;
//   quantile
//                 p of n sorted samples stands at place p (n + 1), between two by a straight line
//   CRPS          mean over coordinates of E|X - y| - E|X - X'| / 2; mm
//   energy score  the same of whole poses, with their Euclidean distance; mm
//   best of n     the smallest MPJPE among the samples; smaller with every sample more, so it shows
//                 what is among them and judges nothing
#pragma once

#include "ident/forecasts/forecast_errors.h"
#include "models/generators/motion_generator.h"

namespace pushid {

inline constexpr double kSpreadLevel = 0.9;
// Below 19 samples the 5 % quantile would stand before the first.
inline constexpr int kLeastSamples = 19;

struct SpreadScores {
  HorizonErrors coverage{}, crps{}, energy{}, best{};
};

struct ForecastSpread {
  std::map<std::string, SpreadScores> actions;
  SpreadScores mean;
};

// The value at quantile p of sorted values.
double SampleQuantile(const std::vector<double>& sorted, double p);

// samples: [window][future].
ForecastSpread SpreadOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<std::vector<SampledFuture>>& samples,
                        const ParticleLayout& layout);

// Adds "coverage_90", "CRPS_mm", "energy_score_mm" and "best_of_n_MPJPE_mm" by horizon beside the
// errors that `json` holds.
void AddSpreadJson(const ForecastSpread& spread, nlohmann::ordered_json* json);
std::string ForecastSpreadText(const ForecastSpread& spread);

}  // namespace pushid
