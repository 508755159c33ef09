// ident: what the estimates become where the priors were others: centres and widths halved,
// doubled.
//
// A parameter that the recordings know keeps its value. Profiles and bootstrap cannot tell: they
// carry the same priors.
#pragma once

#include "ident/uncertainty/refit_table.h"

namespace pushid {

// Two rows, halved and doubled, refitted from the estimate at the same weights of the data; none
// where no free parameter has a prior.
RefitTable CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                       const Uncertainty& uncertainty);

// Whether every refit leaves parameter `index` inside its 95 % interval; a failed one does not.
bool PriorsLeaveInside(const RefitTable& check, size_t index, const Uncertainty& uncertainty);

}  // namespace pushid
