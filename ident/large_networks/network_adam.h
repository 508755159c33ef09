// ident: Adam over the weights of a large network (large_network_fit.h).
#pragma once

#include <vector>

#include "ident/large_networks/network_judge.h"

namespace pushid {

inline constexpr int kRecordingsOfAStep = 8;

// Adam (Kingma and Ba, 2015) with its usual constants, on kRecordingsOfAStep recordings at a time,
// dealt out once and taken in random order: fit.options.max_iterations passes over all of them, or
// max_seconds. The rate falls to a hundredth of fit.options.rate. A gradient more than twice as
// long as those before on average is shortened to that: it tells of somebody who is about to fall.
// Where a rollout leaves the domain, the frames before count, and solution->training_failures
// counts it. x: moved; training: as large_network_fit.h shortens them. Errors: what AdjointGradient
// refuses; a cost or gradient that is not finite.
MaybeError SolveByAdam(const LargeNetworkFit& fit, const std::vector<AdjointRecording>& training,
                       NetworkJudge* judge, std::vector<double>* x, LargeNetworkSolution* solution);

}  // namespace pushid
