// apps: the flags of pushid-fit that ask how sure a fit is: profiles, bootstrap, other
// pushes, shorter horizons, and what to record next.
#pragma once

#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

// gflags wants a value after --profile; alone it means all.
void AllowBareProfile(int argc, char** argv);

// What is wrong with the flags, before a long fit.
MaybeError CheckConfidenceFlags();

// What a bootstrap draws, by flag.
ClusterBy BootstrapBy();

// The same against what is to be fitted: recordings to draw from, a parameter to design for.
MaybeError CheckConfidence(const FitOptions& options, int recordings);

// Adds what the flags ask for.
MaybeError AddConfidence(const std::vector<PendulumRecording>& recordings, FittedModel* model);

// What --population prints, or nothing.
std::string FlaggedPopulation(const FitResult& result);

// The table of --design, or nothing.
Result<std::string> FlaggedDesign(const std::vector<PendulumRecording>& recordings,
                                  const FitResult& result);

}  // namespace pushid
