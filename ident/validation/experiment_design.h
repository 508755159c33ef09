// ident: which further recording would tell most: the drop of standard errors that one more push of
// a kind would bring.
//
// A recording's own gains deviate from the shared ones by the spread T between recordings, and are
// seen through noise. With V the covariance clustered by the G present recordings, V_naive the one
// that takes all errors for noise, and I_c = J_c'J_c / sigma^2 of a candidate, whose Jacobian comes
// from rolling the model out at the estimate (no data needed):
//
//   V' = (V^-1 + (I_c^-1 + T)^-1)^-1,   T = G (V - V_naive), its positive part
//
// However strong the push, one more recording lowers the error of a parameter that recordings
// disagree on by no more than about sqrt(G / (G + 1)); one that is only drowned in noise may gain
// more. Rejected: det(J'J + J_c'J_c) alone, which believes that people are alike and promises far
// too much of one recording; the error of the very fit that would follow, which a single strong
// recording can make worse.
//   c-optimal: smallest V'_ii of a chosen parameter; D-optimal: smallest det V'.
// Errors of parameters on a bound, and null directions, are left out.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/uncertainty/uncertainty.h"
#include "ident/validation/study_plan.h"

namespace pushid {

struct CandidatePush {
  double direction_deg = 0.0;  // from forward (+x) towards left (+y)
  double acceleration = 0.0;   // peak force over mass, m/s^2
  double height = 1.0;         // of the contact, fraction of the rod
  double duration_s = 0.1;     // of the recorded part
  double mass_kg = 80.0;       // of the person
};

struct DesignRow {
  CandidatePush push;
  std::vector<double> error_ratio;  // standard error with one more such recording over the present
  double volume_ratio = 1.0;  // of det V, the P-th root of its square root: mean of the errors
};

struct ExperimentDesign {
  std::string refused;  // why there is none: people who touch, too few recordings
  std::vector<std::string> parameters, units;
  std::vector<double> standard_error;  // now
  PushKind kind = PushKind::kNet;      // of the candidates: that of most recordings
  std::vector<DesignRow> rows;         // candidates that fell are left out
  StudyPlan studies;                   // a force sensor, more people; even where there is no push
};

// Directions forward, oblique, sideways and back; strengths, durations and masses as wide as those
// of the recordings; at the hip and lower.
std::vector<CandidatePush> DefaultCandidates(const std::vector<PendulumRecording>& recordings);

// uncertainty: which parameters have an error to lower.
ExperimentDesign DesignExperiments(const FitProblem& problem, const FitPoint& estimate,
                                   const Uncertainty& uncertainty, const ErrorParts& parts,
                                   const std::vector<CandidatePush>& candidates);

// What one more default candidate, a sensor and more people would bring to a finished fit.
// recordings: those it was fitted to.
ExperimentDesign DesignExperiments(const std::vector<PendulumRecording>& recordings,
                                   const FitResult& result);

// The rows by what they bring to a parameter, or to all together ("all"), best first. Errors: the
// design's refusal, no such parameter.
Result<std::vector<DesignRow>> RankedRows(const ExperimentDesign& design,
                                          const std::string& parameter);

// The recording a candidate would be: an upright person at rest, and the motion that the model
// expects.
PendulumRecording MakeCandidate(const FitProblem& problem, const FitPoint& estimate,
                                const CandidatePush& push, PushKind kind);

}  // namespace pushid
