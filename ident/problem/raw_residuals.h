// ident: residuals of whole recordings before any weight.
#pragma once

#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

using ResidualsByRecording = std::vector<std::vector<double>>;

// In sigmas: FrameResidual's, by frame from frame 1 on, then person; then those of
// platforms (cost_functions/plate_residual.h). Empty where a rollout leaves the domain, and where
// it is not wanted (wanted: by recording; empty: all).
ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  const std::vector<bool>& wanted = {});

// The same of each of these.
std::vector<std::vector<double>> ResidualsOf(const std::vector<RolloutAt>& rollouts);

// Those of a problem without the robust loss.
ResidualSigmas PlainSigmas(const FitProblem& problem);

}  // namespace pushid
