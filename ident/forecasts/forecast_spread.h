// ident: errors of forecasts, and scores of sampled futures, by horizon.
//
//   coverage      share of coordinates whose truth lies in the central 90 % of the samples;
//                 quantile p of n sorted samples is at rank p (n + 1), interpolated linearly
//   CRPS          mean over coordinates of E|X - y| - E|X - X'| / 2; mm
//   energy score  the same for whole poses, with the Euclidean distance; mm
//   most probable MPJPE of the future with the largest likelihood of its transitions: the optimum
//                 path among the samples, without a given end (Fig. 5 of SDE)
//   best of n     the smallest MPJPE among the samples, which falls with their number and therefore
//                 is no score
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/generator_data.h"
#include "models/generators/motion_generator.h"

namespace pushid {

// Errors of forecasts by action and horizon.
//
// MPJPE: mean distance over all 38 joints of CMU's skeleton; joints that share a place share its
// error, and joints that never move have none. The overall mean is the mean of the actions' means.

using HorizonErrors = std::array<double, kHorizonFrames.size()>;  // m

// Means over windows, by horizon; m, and coverage as a share.
struct WindowScores {
  int windows = 0;
  HorizonErrors mpjpe{};
  HorizonErrors coverage{}, crps{}, energy{}, probable{}, best{};  // of sampled futures
};

struct ForecastScores {
  std::map<std::string, WindowScores> actions;
  WindowScores mean;     // of the actions
  bool sampled = false;  // whether futures were sampled
};

// With fewer than 19 samples the 5 % quantile would lie before the first.
inline constexpr int kLeastSamples = 19;

// forecasts: one per window. samples: [window][future], or none at all.
ForecastScores ScoresOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<Trajectories>& forecasts, const ParticleLayout& layout,
                        const std::vector<std::vector<SampledFuture>>& samples = {});

// The last observed pose, repeated.
std::vector<Trajectories> ZeroVelocity(const std::vector<ForecastWindow>& windows);

// {"mean": {"windows": 8, "MPJPE_mm": {"80": ...}}, "actions": {"walking": ...}}; of sampled
// futures also "coverage_90", "CRPS_mm", "energy_score_mm", "most_probable_MPJPE_mm",
// "best_of_n_MPJPE_mm".
nlohmann::ordered_json ToJson(const ForecastScores& scores);
// A table with a row for each action and their mean, and one of sampled futures.
std::string ForecastScoresText(const ForecastScores& scores);

// The most probable path to a pose (SDE's Fig. 5): of the futures whose last pose is near a target,
// the one whose transitions have the largest likelihood.
struct PathChoice {
  int future = 0;         // its index
  int near = 0;           // how many futures ended near enough
  double distance = 0.0;  // of its last pose from the target, mean of joints, m
  double log_likelihood = 0.0;
};

// Errors: no future ends within `distance` (m) of the target; the message says how near they come.
Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout);

}  // namespace pushid
