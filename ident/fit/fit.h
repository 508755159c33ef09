// ident: a whole fit: prepared, solved, judged.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/parameters/fit_options.h"
#include "ident/solver/solution.h"

namespace pushid {

// Makes options fit for these recordings: holds what can have no effect on any of them (the tail,
// where every push is measured whole), pools nothing where all belong to one unit, and adds the
// slopes of covariates and contrasts to the table (covariates.h). Errors: invalid options, nothing
// left to fit, a free parameter without effect, those of AddCovariates. warnings (may be null):
// people who touch without any term between them; masses, rods, pushes and motions that no person
// has. Every fit begins with it: of the programs, of cross-validation, of users of the library.
MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      Warnings* warnings = nullptr);

// Fits and judges prepared options. A fit without a usable optimum is not ok(), and its message
// says why.
FitResult Fit(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
              const SolveProgress& progress = nullptr);

// The same solve without a judgement: for folds, whose models only predict. It prepares the options
// itself. forecasts: whether the model is to predict from first frames, which it learns from folds
// of its own. Errors: those of PrepareFit; no usable optimum.
Result<IdentifiedModel> SolveModel(const std::vector<PendulumRecording>& recordings,
                                   FitOptions options, bool forecasts = false);

}  // namespace pushid
