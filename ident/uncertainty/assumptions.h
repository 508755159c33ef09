// ident: what a fit takes as known: pushes, bodies, clocks, cameras, and the parameters that are
// not fitted. Each is a number eta, 0 as it was taken.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

// What a fit sees, with something changed.
struct ChangedProblem {
  std::vector<PendulumRecording> recordings;
  FitOptions options;
};

struct Assumption {
  std::string name;    // "scale of the pushes"; "Kd_theta"
  std::string unit;    // of eta; empty: a share, or a logarithm of a factor
  double sigma = 0.0;  // standard deviation that is stated of eta; 0: none, it is only tested
  double step = 0.0;   // of differences
  std::function<void(double eta, ChangedProblem*)> change;
};

// Stated of what was measured: 5 % of a push's force, a frame between its clock and that of the
// cameras, 5 cm of its height, 3 % of a mass, 1 % of the frame rate, 5 mm that cameras drift along
// the push over a recording. Pushes by inverse dynamics have neither a clock nor a height of their
// own, and follow the masses. Of a held gain, a factor of two; of a term left out, nothing.
inline constexpr double kPushScaleError = 0.05, kPushLagError = 1.0, kPushHeightError = 0.05;
inline constexpr double kMassError = 0.03, kFrameRateError = 0.01, kDriftError = 0.005;

// Those of a problem that can have an effect.
std::vector<Assumption> AssumptionsOf(const FitProblem& problem);

}  // namespace pushid
