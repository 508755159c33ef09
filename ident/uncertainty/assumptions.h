// ident: what a fit takes as known: pushes, bodies, clocks, cameras, and the parameters that are
// not fitted. Each is a number eta, 0 as it was taken.
#pragma once

#include <vector>

#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/covariance.h"

namespace pushid {

// The stated errors of measured pushes are the largest of the recordings'
// (datasets/manifest/laboratory_keys.h). Pushes by inverse dynamics have neither a clock, a height
// nor a zero of their own, and follow the masses. A held gain is stated to a factor of two, a term
// left out not at all. People react late, whether their feet hold or not: a torque Kp e(t - tau) is
// Kp e - tau Kp e' at first order, so that the damping that is fitted is Kd - tau Kp. What is
// beyond the first order tells whether they do: the problem with a delay of 0.12 s, and Kd greater
// by it, against the problem as it is.
inline constexpr char kReactionDelayName[] = "reaction delay";

// Semi-implicit Euler at the recording's rate errs at first order in its step, people do not move
// in steps: eta is how much longer the step is, and the column is the difference that half the step
// makes (eta = -0.5). Without any step eta is -1, so that +- 1 is stated, whatever the rate.
inline constexpr char kStepName[] = "step of the integrator";

// The largest of the recordings.
StatedErrors Stated(const std::vector<PendulumRecording>& recordings);

// Steps of what has a typical size, in shares of that.
inline constexpr double kScaleStep = 1e-4;

// The assumptions of a problem that can have an effect.
std::vector<Assumption> AssumptionsOf(const FitProblem& problem, const FitPoint& point);

// With all that is taken as it is: what the covariances of a fit (uncertainty.h) are computed from.
// curvature: with second derivatives, unless feet step or there are too many columns.
struct ScoredFit {
  ResidualRows score;
  std::vector<FittedColumn> columns;
  Eigen::VectorXd unit;
  Clusters clusters;
  Clustering clustering;
};
ScoredFit ScoreAt(const FitProblem& problem, const FitPoint& point, bool curvature = true);

}  // namespace pushid
