// ident: how the estimates depend on the horizon.
//
// A parameter that means something keeps its value however long the rollouts are; one that drifts
// stands for what the model leaves out. The fit is repeated on the first 8, 16, 32 and 64 frames of
// every recording (the stages of the solver, FitOptions::horizons), each on its own from its own
// start and with everything that the whole fit has: priors, settling, tolerances. Rejected: the
// values at the ends of the solver's stages, which come for free but stop early (1e-4), lean on
// priors of their own and know no settling.
//
// Two fits of one study share their people, so their difference is known better than either value;
// that it is larger than twice the larger of the two errors is called a drift.
//
// Before them stands what single steps want: the innovation likelihood of all recordings
// (solver/likelihood_solve.h), with the noise of process and measurement fitted beside the same
// parameters. It answers how people react from one frame to the next, the whole fit where a push
// takes them; where both want different values, neither may be quoted for the other. Models with a
// memory have no such row.
#pragma once

#include "ident/uncertainty/refit_table.h"

namespace pushid {

inline constexpr int kOneStep = 1;  // frames

// A row for single steps, and for each horizon that is shorter than some recording, ascending; the
// whole fit is what they are compared with.
RefitTable CheckHorizons(const FitProblem& problem, const FitPoint& estimate,
                         const Uncertainty& uncertainty, int num_threads,
                         const JobProgress& progress = nullptr);

struct Drift {
  size_t parameter = 0, row = 0;  // the row where it is farthest, in errors
  double in_errors = 0.0;         // of the larger of both
};
std::vector<Drift> Drifts(const RefitTable& horizons);

}  // namespace pushid
