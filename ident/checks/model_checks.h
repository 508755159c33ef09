// ident: checks of a finished model: its intervals by other methods (profiles, bootstrap), its
// parameters from fewer frames, and which push to record next. pushid-check runs them on a model's
// file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

struct ModelChecks {
  std::string profile;         // names, comma-separated; all; empty: none
  BootstrapOptions bootstrap;  // of which `replicas` may be 0: none
  bool horizon_check = false, learn_forecasts = false;
  std::string design;  // a parameter, or all; empty: none
  int num_threads = 1;

  // True where the checks add to the model; a design is only printed.
  bool Adds() const {
    return !profile.empty() || bootstrap.replicas > 0 || horizon_check || learn_forecasts;
  }
  bool Any() const { return Adds() || !design.empty(); }
};

// Checks the numbers before a long fit. Errors name the flag.
MaybeError CheckNumbers(const ModelChecks& checks);
// Checks them against what is, or was, fitted.
MaybeError CheckAgainst(const ModelChecks& checks, const FitOptions& options,
                        const std::vector<PendulumRecording>& recordings);

// The recordings that the model was fitted to, in its order and as often, out of those given.
// Errors: one is missing, differs from what was fitted, or was not fitted.
Result<std::vector<PendulumRecording>> AsFitted(const std::vector<PendulumRecording>& given,
                                                const FitResult& fit);

// A model from a file as it was when Fit returned it: what refits start from is complete again.
// Errors: the recordings have other units or sizes than those of the fit.
MaybeError ResumeFit(const std::vector<PendulumRecording>& recordings, FitResult* fit);

// Adds the checks to a model that came from Fit, or ResumeFit, of these very recordings, and the
// advice that follows. progress: of the check of that name.
MaybeError AddChecks(const std::vector<PendulumRecording>& recordings, const ModelChecks& checks,
                     const std::function<JobProgress(const std::string&)>& progress,
                     FittedModel* model);

// The results of the checks, with forecasts and design, which the model does not keep.
Result<Screen> CheckScreen(const std::vector<PendulumRecording>& recordings,
                           const ModelChecks& checks, const FittedModel& model);

// Single checks of a model that came from Fit of these very recordings.
MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FittedModel* model);
MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FittedModel* model);
// Learns what predictions from first frames need. Error: every recording leaves the model's domain.
MaybeError AddForecasts(const std::vector<PendulumRecording>& recordings, int num_threads,
                        FittedModel* model);
void AddHorizonCheck(const std::vector<PendulumRecording>& recordings, int num_threads,
                     const JobProgress& progress, FittedModel* model);

}  // namespace pushid
