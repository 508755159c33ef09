// ident: diagnostics before and after the solve, as data: every table and plot of a report is drawn
// from here.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/inspection/findings.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"
#include "ident/solver/solution.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

class FitProblem;

// Diagnostics of the start of the solve.
struct StartDiagnostics {
  double condition_number = 0.0;               // of the scaled Jacobian, without null directions
  std::vector<NullDirection> null_directions;  // of the recordings alone, without priors
  std::vector<std::string> without_effect;     // free parameters whose column is zero
  std::vector<std::string> notes;              // starts moved off a bound
  std::vector<Finding> findings;               // what of the recordings cannot be right
};

// A frame that the robust loss gives less than half its weight.
struct Outlier {
  int frame = 0;
  int person = 0;
  double error = 0.0;   // |r| before the robust weight, in sigmas
  double weight = 0.0;  // w^2 of frame_residual.h, in (0, 1]
};

struct RecordingDiagnostics {
  std::string id;
  double explained = 0.0;  // % of the hip's horizontal variation: 100 (1 - |error|^2 / |motion|^2)
  bool moved = true;       // whether a hip went 2 cm; else a share of its motion says little
  double cost = 0.0;       // in the objective
  double lag1 = 0.0;       // lag-1 autocorrelation of the hip's forward error
  double ljung_box = 0.0;  // of that error over the lags of Whiteness
  double ljung_box_p = 0.0;  // small: the error is no white noise
  std::vector<Outlier> outliers;
};

// Whether standing still predicts it better.
inline bool WorseThanStatic(const RecordingDiagnostics& r) { return r.moved && r.explained < 0.0; }

// One residual channel over all recordings: its correlation with itself and with the push, lag by
// lag. A correlation is the mean over recordings; `error` is the standard error of that mean.
struct Whiteness {
  std::string channel;                         // "hip x", "theta", ...
  std::vector<double> autocorrelation, error;  // lags 1, 2, ...
  std::vector<double> push, push_error;        // with the push `lag` frames before, lags 0, 1, ...
  double band = 0.0;       // +- of white noise in one recording, 95 %: 1.96 / sqrt(frames)
  double mean_band = 0.0;  // the same of the mean over recordings
  double ljung_box = 0.0;  // summed over recordings, with its p-value
  double ljung_box_p = 0.0;
};

// Moves when a recording is left out, by one step (covariance.h). Checked against real refits in
// tests/ident/diagnostics/diagnostics_test.cc.
struct Leverage {
  std::vector<std::string> recordings, parameters, units;
  std::vector<std::vector<double>> change;     // [recording][parameter], natural units
  std::vector<std::vector<double>> in_errors;  // the same over the clustered standard error
};

struct Advice {
  std::string sentence;
  std::string command;  // the next one to try; may be empty
};

struct Diagnostics {
  StartDiagnostics start;
  std::vector<RecordingDiagnostics> recordings;
  std::vector<Whiteness> whiteness;
  Leverage leverage;
  std::vector<TracePoint> trace;  // of the best start
};

// Whether every push is external, measured whole: then none has a tail.
bool TailCannotAct(const std::vector<PendulumRecording>& recordings);

// Holds the parameters of the tail where it cannot act.
void HoldUnusedTail(const std::vector<PendulumRecording>& recordings, FitOptions* options);

// Free parameters that change no residual of the recordings, neither at the nominal values nor near
// them: an error that names them. To be asked before a solve.
MaybeError CheckEffects(const FitProblem& problem);

// All diagnostics except the advice, which also needs profiles and bootstrap
// (report/report_text.h).
Diagnostics Diagnose(const FitProblem& problem, const SolveStart& best,
                     const Uncertainty& uncertainty);

}  // namespace pushid
