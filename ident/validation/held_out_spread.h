// ident: is the spread that models predict, by bands or by drawn futures, right for recordings that
// were not fitted?
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ident/prediction/futures.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/problem/folds.h"
#include "ident/problem/parallel.h"
#include "ident/problem/statistics.h"

namespace pushid {

// Values of held-out recordings, each averaged over the repeats that held it out.
struct HeldOutValues {
  std::vector<int> recording;  // index of each
  std::vector<std::vector<double>> values;
};

// held_out: the metrics (kFuturesMetrics), for paired differences. A fold without a fit is left out
// and counted.
struct HeldOutFutures {
  FuturesSummary summary;
  int folds_without_fit = 0;
  HeldOutValues held_out;
};
HeldOutFutures CrossValidateFutures(const std::string& name,
                                    const std::vector<PendulumRecording>& recordings,
                                    const std::vector<Fold>& folds, const FitOptions& options,
                                    int draws, uint64_t seed, int num_threads,
                                    const JobProgress& progress = nullptr);

// Means, and differences of each from the first, over the recordings that both have.
std::string HeldOutFuturesText(const std::vector<PendulumRecording>& recordings,
                               const std::vector<HeldOutFutures>& all);

nlohmann::ordered_json ToJson(const FuturesSummary& summary);

// Share of frames whose measured hip lies within a band, of the pushed person, by axis x and y;
// means over recordings with standard errors over their clusters (prediction/evaluation.h).
struct BandCoverage {
  bool model_error = false;
  int recordings = 0;
  std::string clusters;  // "4 people"
  MeanAndError inside50[2], inside90[2];
  MeanAndError width90[2];  // m
};

// Coverage of recordings that were not fitted, with and without model error.
std::vector<BandCoverage> CrossValidateBands(const std::vector<PendulumRecording>& recordings,
                                             const std::vector<Fold>& folds,
                                             const FitOptions& options, const BandOptions& bands,
                                             int num_threads,
                                             const JobProgress& progress = nullptr);

std::string BandCoverageText(const std::vector<BandCoverage>& coverage);

}  // namespace pushid
