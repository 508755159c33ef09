// ident: ensembles: networks trained from several seeds, whose predictions are put together by
// their median (prediction/prediction.h), so that one bad seed does no harm. Members that
// leave the model's domain do not count while most of them stay in it.
#pragma once

#include <memory>
#include <vector>

#include "models/learned_terms.h"
#include "models/parameters.h"

namespace pushid {

struct FitOptions;
struct PendulumRecording;

// What one seed found.
struct EnsembleMember {
  ParameterSet<double> parameters{};
  std::shared_ptr<const LearnedTerms> network;
};

// The fits of all seeds but the first (options.seed), one by one; a seed without a usable optimum
// is left out.
std::vector<EnsembleMember> FitOtherSeeds(const std::vector<PendulumRecording>& recordings,
                                          const FitOptions& options);

}  // namespace pushid
