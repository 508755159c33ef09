// ident: covariates of people and contrasts between them, as rows of the table of parameters.
//
// A slope is fitted together with everything else: a parameter "Kp_theta~age" whose standard
// error, shares, status and profile are found as those of any other. It is free, starts at 0, and
// has a weak prior: N(0, 1) on a log scale, N(0, typical size) of the others, of what one standard
// deviation of a number moves, or of the difference between the two values of a label.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Slopes need people who differ: at least so many values of a number.
inline constexpr int kLeastDistinctValues = 3;

// Adds the slopes of options->contrast and options->covariates to the table. Where it has slopes
// already (a fold of a prepared fit), they stay as they are. `told` (not null): what was done.
//
// A contrast is of every free parameter, noise excepted, and of those that two people share only
// where a recording's people all have the same value of the label. A parameter that differs by
// the same label is no longer pooled.
// Errors: an unknown parameter, or a fixed one; a number or label that nobody has (with those that
// there are) or somebody lacks; fewer than three distinct numbers; other than two values of the
// label; more slopes than there is room for; a network that is trained by its gradient.
MaybeError AddCovariates(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                         Warnings* told);

// Differences in standard deviations between people.

// Where the fit does not let people differ, a second one does: each parameter that is compared
// deviates by person, and its spread is estimated (problem/fit_problem.cc), while the contrast
// takes away what the label explains. Differences, intervals and p values remain those of the fit
// itself. An effect stays untold where no spread is found, of what two people share, where fewer
// than kFewestPeople people were recorded or nobody more than once, and where that fit fails.
void AddContrastEffects(const std::vector<PendulumRecording>& recordings, FitResult* result);

}  // namespace pushid
