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
// already (a fold of a prepared fit), they stay as they are. warnings (not null) say what
// was done.
//
// A contrast is of every free parameter, noise excepted, and of those that two people share only
// where a recording's people all have the same value of the label. A parameter that differs by
// the same label is no longer pooled.
// Errors: an unknown parameter, or a fixed one; a number or label that nobody has (with those that
// there are) or somebody lacks; fewer than three distinct numbers; other than two values of the
// label; more slopes than there is room for; a network that is trained by its gradient.
MaybeError AddCovariates(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                         Warnings* warnings);

// Differences judged by people's own fits (uncertainty/contrast.h): everybody who was recorded
// alone is fitted alone where each value holds, which costs about as much as the joint fit. Where
// people share recordings, numbers are covariates too, a likelihood of single steps is fitted, or
// somebody alone has no usable optimum, differences stay as the joint fit has them, without
// effects.
void JudgeContrastByPeople(const std::vector<PendulumRecording>& recordings, FitResult* result);

}  // namespace pushid
