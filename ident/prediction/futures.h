// ident: futures drawn from a model: rollouts from the same start and push, driven by its process
// noise; where feet step (models/stance.h), people whose supports are spread as P(step) has it
// (fit/step_probability.h), so that the share of draws in which a person steps is P(step).
//
// Noise of single steps adds up: what a hundred drawn steps scatter by is the model's own word on
// how far people stray. Beside it stand the bands of predictive_bands.h, which take the errors of
// the fitted recordings instead. Of a set of n draws coverage is counted between order statistics
// whose ranks are p (n + 1); CRPS and energy score are the unbiased estimates of Gneiting and
// Raftery 2007 (Eq. 20 and 22): the lower, the better, in the unit of what is scored.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/predictive_bands.h"

namespace pushid {

struct Futures {
  std::string id;
  int failed = 0;  // draws that left the domain: in none of the paths
  // [draw][person][frame]: hip (m), theta and phi (rad).
  std::vector<std::vector<std::vector<BandPoint>>> paths;
  std::vector<std::vector<int>> steps;  // [draw][person]: how many; empty where feet do not step
};

// What is wrong with drawing from a model: nothing in it is spread.
MaybeError CheckDrawsFrom(const IdentifiedModel& model);

// num_frames: 0 means as many as the recording has. Errors: as CheckDrawsFrom.
Result<Futures> DrawFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                            int draws, uint64_t seed, int num_frames = 0);

// For scores over recordings, whose draws are to be independent.
uint64_t SeedOfRecording(uint64_t seed, int recording);

// Unbiased CRPS of draws against a value.
double Crps(std::vector<double> draws, double value);

// How well draws tell what came, over the measured frames from frame 1 on, and people.
struct FuturesScore {
  // Shares of frames within the central 50 and 90 % of the draws, and CRPS: of the hip's x and y
  // and of theta and phi.
  double inside50[4] = {}, inside90[4] = {}, crps[4] = {};
  double energy = 0.0;    // m, of the hip's horizontal place
  double deviance = 0.0;  // -2 log innovation likelihood, of one measured number; NaN without noise

  std::vector<double> Values() const;  // of the metrics below
};
FuturesScore ScoreFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                          const Futures& futures);

struct FuturesMetric : Metric {
  double (*value)(const FuturesScore&);
};
inline constexpr FuturesMetric kFuturesMetrics[] = {
    {{"inside50_x", "1"}, [](const FuturesScore& s) { return s.inside50[0]; }},
    {{"inside90_x", "1"}, [](const FuturesScore& s) { return s.inside90[0]; }},
    {{"inside90_y", "1"}, [](const FuturesScore& s) { return s.inside90[1]; }},
    {{"inside90_theta", "1"}, [](const FuturesScore& s) { return s.inside90[2]; }},
    {{"inside90_phi", "1"}, [](const FuturesScore& s) { return s.inside90[3]; }},
    {{"crps_x", "m"}, [](const FuturesScore& s) { return s.crps[0]; }},
    {{"crps_y", "m"}, [](const FuturesScore& s) { return s.crps[1]; }},
    {{"crps_theta", "rad"}, [](const FuturesScore& s) { return s.crps[2]; }},
    {{"crps_phi", "rad"}, [](const FuturesScore& s) { return s.crps[3]; }},
    {{"energy", "m"}, [](const FuturesScore& s) { return s.energy; }},
    {{"deviance", "1"}, [](const FuturesScore& s) { return s.deviance; }},
};

// Means over recordings with standard errors over their clusters (evaluation.h). Values and means
// in the order of kFuturesMetrics.
struct FuturesSummary {
  std::string name;  // of the model, where there are several
  int recordings = 0, draws = 0, failed = 0;
  int without = 0;  // recordings with fewer than two draws that stay in the domain
  std::string clusters;
  std::vector<MeanAndError> mean;
};
FuturesSummary SummarizeFutures(const std::string& name,
                                const std::vector<PendulumRecording>& recordings,
                                const std::vector<std::vector<double>>& values, int draws,
                                int failed);

// The hip of everybody at the last frame: median and central 90 % of the draws; shares of draws by
// number of steps.
std::string LastFrameText(const Futures& futures);

// A row for each metric, a column for each summary.
std::string FuturesText(const std::vector<FuturesSummary>& summaries);

// Draws and scores for every recording.
Result<FuturesSummary> EvaluateFutures(const IdentifiedModel& model,
                                       const std::vector<PendulumRecording>& recordings, int draws,
                                       uint64_t seed);

}  // namespace pushid
