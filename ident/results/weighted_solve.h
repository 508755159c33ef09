// ident: a solve whose data weigh as much as they know.
#pragma once

#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

namespace pushid {

// Solves, estimates what of sigmas and effective frames the options leave to the data
// (uncertainty/data_weight.h), and solves on from there, until neither changes by more than 1 %.
// options: on return with what was estimated.
Solution SolveWeighted(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                       const SolveProgress& progress = nullptr);

}  // namespace pushid
