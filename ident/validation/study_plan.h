// ident: what another study would tell: the same recordings with the push measured, more people,
// more pushes of each.
//
// Where an error comes from. A person's own parameters differ from everybody's with covariance B, a
// recording's from its person's with W, and a recording sees its own through noise, N_1. With R
// recordings of P people, n_p of person p, and f = sum (n_p / R)^2, the covariances that a fit
// shows are
//
//   naive                   N   = N_1 / R
//   clustered by recording  V_R = (W + N_1) / R + (1 - f) / (R - 1) B
//   clustered by person     V_P = (W + N_1) / R + f B
//
// (one-way analysis of variance of what each recording moves), and n pushes of each of P people
// leave
//
//   V(P, n) = B / P + (W + N_1) / (P n)
//
// so that further pushes of the same people never lower an error below that of B / P. Parameter by
// parameter, positive parts only. Every recording counts as the mean of those there are; B and W
// hold what differences in other parameters make of recordings of different kinds, too. B is known
// only as well as a variance of P numbers: to sqrt(1 / (2 (P - 1))) of its root, 40 % for four
// people.
//
// A force sensor. Where a push is known only in its first part, the fit finds the rest (the tail)
// beside everything else, and each recording's own tail scatters everything else. A sensor leaves
// the motion as it is and makes the tail known: its columns drop out of the Jacobian. With d_g the
// deviation of recording g's own parameters, tail included, its rows are r_g = J_g d_g + e,
// d_g ~ N(0, T), e ~ N(0, s^2); T and s come from the rows by EM (Laird and Ware 1982), and with
// H_g = J_g'J_g, H that of all with priors,
//
//   V = H^-1 (sum s^2 H_g + H_g T H_g) H^-1, now with all columns, then without those of the tail
//
// Rejected: what noise alone would gain, which believes that people are alike; the scores of the
// fit as it is with the tail held, where every recording's own tail would go on scattering the
// rest; T from V - N by moments, which a dozen recordings do not determine. Left out: what a sensor
// tells while the push lasts, where the rows of a `net` push replace all other forces; and the
// sensor's own errors (push_check.h). Good to about a factor of two (study_plan_test.cc).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

class FitProblem;
struct FitPoint;
struct ErrorParts;

// One size of a study, and the standard errors it would leave.
struct StudySize {
  int people = 0;
  double pushes = 0.0;  // of each
  std::vector<double> standard_error;
};

struct EquipmentRow {
  std::string equipment;            // "force platforms under the same recordings"
  std::vector<double> error_ratio;  // of each of the parameters asked for: then over now
};

struct StudyPlan {
  std::vector<std::string> parameters, units;
  std::string no_sensor;  // why none is proposed
  // Standard error with the force measured over that without; NaN for the tail's own parameters,
  // which a measured push does not have.
  std::vector<double> sensor_ratio;
  std::string no_sizes;  // why the errors cannot be split
  // Standard deviations: between people, of what a person's recordings move about their mean, and
  // of what one recording tells through its noise.
  std::vector<double> between_people, between_recordings, noise;
  std::vector<StudySize> sizes;  // the first: as it is
  std::vector<EquipmentRow> equipment;
};

// The errors of the shared parameters `known` (indices), in natural units.
StudyPlan PlanStudies(const FitProblem& problem, const FitPoint& estimate, const ErrorParts& parts,
                      std::vector<int> known);

// known: of the shared parameters, those that are asked for. Rows that a fall spoils, and equipment
// that the recordings have, are left out.
std::vector<EquipmentRow> PlanEquipment(const FitProblem& problem, const FitPoint& estimate,
                                        const ErrorParts& parts, const std::vector<int>& known);

// The standard error that `people` with `pushes` each would leave of a plan's parameter.
double ExpectedError(const StudyPlan& plan, size_t parameter, double people, double pushes);

// N, V_R and V_P: what the errors of a fit are made of; covariances on the fitted scale, in the
// order of FitPoint::Flat, whatever the fit's own clusters are.
struct ErrorParts {
  JacobianBlocks score;  // by recording
  double sigma = 0.0;
  Eigen::MatrixXd naive;
  Eigen::MatrixXd by_recording;  // empty with a single recording
  Eigen::MatrixXd by_person;     // by who is pushed; empty with a single person
  std::vector<int> person;       // of each recording, from 0

  int num_recordings() const { return static_cast<int>(person.size()); }
};
ErrorParts ErrorPartsAt(const FitProblem& problem, const FitPoint& estimate);

// Which further recording would tell most: the drop of standard errors that one more push of
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
