// ident: the fit repeated under other circumstances - other priors, fewer frames, other pushes
// (push/push_check.h) - side by side with the fit itself.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/fit_point.h"
#include "ident/problem/parallel.h"

namespace pushid {

class FitProblem;
struct SolveStart;
struct Uncertainty;

struct RefitRow {
  std::string source;  // what varies: rows of one source are told apart by `name`
  std::string name;
  std::vector<double> value;           // by parameter, natural units; empty where it failed
  std::vector<double> standard_error;  // empty where it was not computed
  std::string failure;
  int frames = 0;  // that were fitted; 0: all
};

// Of every free shared parameter.
struct RefitTable {
  std::vector<std::string> parameters, units;
  std::vector<double> value, standard_error;  // of the fit
  std::vector<RefitRow> rows;
};

// The table without rows.
RefitTable RefitTableOf(const FitProblem& problem, const FitPoint& estimate,
                        const Uncertainty& uncertainty);

// What a refit found, or why it says nothing.
void Take(const FitProblem& problem, const SolveStart& refit, RefitRow* row);

// Shared parameters at a point, natural units.
std::vector<double> SharedValues(const FitProblem& problem, const FitPoint& point);

// How the estimates depend on the horizon.
//
// A parameter that means something keeps its value however long the rollouts are; one that drifts
// stands for what the model leaves out. The fit is repeated on the motion up to 8, 16, 32 and 64
// frames after the first push of every recording began (the stages of the solver,
// FitOptions::horizons), each on its own from its own start and with everything that the whole fit
// has: priors, settling, tolerances. Rejected: the values at the ends of the solver's stages, which
// come for free but stop early (1e-4), lean on priors of their own and know no settling.
//
// Two fits of one study share their people, so their difference is known better than either value;
// that it is larger than twice the larger of the two errors is called a drift.
//
// Before them stands what single steps want: the innovation likelihood of all recordings
// (solver/solver.h), with the noise of process and measurement fitted beside the same
// parameters. It answers how people react from one frame to the next, the whole fit where a push
// takes them; where both want different values, neither may be quoted for the other. Models with a
// memory have no such row.

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
// The same of single steps. No drifts: noise of the joints moves them too, as the posture that
// people return to is taken from one frame, and what that errs by acts in every step.
std::vector<Drift> MovesOfSingleSteps(const RefitTable& horizons);

// What the estimates become where the priors were others: centres and widths halved, doubled.
//
// A parameter that the recordings know keeps its value. Profiles and bootstrap cannot tell: they
// carry the same priors.

// Two rows, halved and doubled, refitted from the estimate and from the priors' centres at the same
// weights of the data, without the demand to settle where that is contradicted then; none where no
// free parameter has a prior.
RefitTable CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                       const Uncertainty& uncertainty);

// Whether every refit leaves parameter `index` inside its 95 % interval; a failed one does not.
bool PriorsLeaveInside(const RefitTable& check, size_t index, const Uncertainty& uncertainty);

}  // namespace pushid
