// ident: are drawn futures right for what was not fitted?
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ident/prediction/futures.h"
#include "ident/problem/folds.h"
#include "ident/problem/parallel.h"

namespace pushid {

// Of recordings that were not fitted, each one's scores averaged over the repeats that held it out;
// held_out: those scores, for paired differences. A fold without a fit is left out and counted.
struct HeldOutFutures {
  FuturesSummary summary;
  int folds_without_fit = 0;
  std::vector<int> recording;  // index of each
  std::vector<FuturesScore> held_out;
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

}  // namespace pushid
