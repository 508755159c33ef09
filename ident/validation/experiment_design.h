// ident: which further push would lower the standard errors of a fit most.
//
// Recordings deviate from the shared parameters by the spread T, and are seen through noise. With V
// the covariance clustered by the G recordings, V_naive the one that takes all errors for noise,
// and I_c = J_c'J_c / sigma^2 of a candidate, rolled out at the estimate:
//   V' = (V^-1 + (I_c^-1 + T)^-1)^-1,   T = G (V - V_naive), its positive part
// Rejected: det(J'J + J_c'J_c), which takes people for alike and promises far too much of one
// recording. Errors of parameters on a bound, and null directions, are left out.
#pragma once

#include <string>
#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

class FitProblem;
struct Covariance;

struct CandidatePush {
  double direction_deg = 0.0;  // from forward (+x) towards left (+y)
  double acceleration = 0.0;   // peak force over mass, m/s^2
  double height = 1.0;         // of the contact, fraction of the rod
  double duration_s = 0.1;     // of the recorded part: to the peak without a sensor
  double mass_kg = 80.0;       // of the person
  bool sensor = false;         // whether the whole push is measured
};

struct DesignRow {
  CandidatePush push;
  // Standard errors with one more such recording over the present ones; behind them their mean, the
  // P-th root of the square root of the ratio of det V.
  std::vector<double> error_ratio;
};

struct ExperimentDesign {
  std::vector<Estimate> parameters;  // with their standard errors now, by the data alone
  std::vector<DesignRow> rows;       // candidates that fall are left out
};

// The recording that the model expects; without states where the person falls.
PendulumRecording MakeCandidate(const FitProblem& problem, const FitPoint& estimate,
                                const CandidatePush& push);

// by_recording: the covariance clustered by recording. candidates: none for the default ones, as
// strong, long and heavy as the recordings' own. Error: too few recordings.
Result<ExperimentDesign> DesignExperiments(const FitProblem& problem, const FitPoint& estimate,
                                           const Uncertainty& uncertainty,
                                           const Covariance& by_recording,
                                           std::vector<CandidatePush> candidates = {});
// Default candidates for a finished fit. Error: other recordings than were fitted.
Result<ExperimentDesign> DesignExperiments(const std::vector<PendulumRecording>& recordings,
                                           const FitResult& result);

// Sorts the rows by what they bring to a parameter, or to all together ("all"), best first: a table
// of the best ten and the least useful one, or why there is no design. Error: no such parameter.
Result<std::string> DesignText(const std::string& parameter, Result<ExperimentDesign>* design);

}  // namespace pushid
