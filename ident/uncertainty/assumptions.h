// ident: what a fit takes as known: pushes, bodies, clocks, cameras, and the parameters that are
// not fitted. Each is a number eta, 0 as it was taken.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"

namespace pushid {

struct Assumption {
  std::string name;    // "scale of the pushes"; "Kd_theta"
  std::string unit;    // of eta; empty: a share, or a logarithm of a factor
  double sigma = 0.0;  // standard deviation that is stated of eta; 0: none, it is only tested
  double step = 0.0;   // of differences
  // What it changes: every recording, or the options of the fit. Null: it leaves them.
  std::function<void(double eta, PendulumRecording*)> of_recording;
  std::function<void(double eta, FitOptions*)> of_options = nullptr;
  // Besides: estimates that go with it, as a change of the first order would be theirs; and how far
  // each shared one does, on the fitted scale, at `step`. The difference is that to a problem which
  // is changed by `step` as a whole, in which they do.
  std::vector<std::pair<size_t, double>> along = {};
  // It scales measured rates, and what is compared with them instead: their noise would ask for
  // less.
  bool of_rates = false;
};

// Stated of what was measured: the largest of the recordings'
// (datasets/manifest/laboratory_keys.h). Pushes by inverse dynamics have neither a clock, a height
// nor a zero of their own, and follow the masses. Of a held gain, a factor of two; of a term left
// out, nothing. Who stands reacts late, by some 0.1 s: a torque Kp e(t - tau) is Kp e - tau Kp e'
// at first order, so that the damping that is fitted is Kd - tau Kp. What is beyond the first order
// tells whether they do: the problem with a delay of 0.12 s, and Kd greater by it, against the
// problem as it is.
inline constexpr char kReactionDelayName[] = "reaction delay";

// The largest of the recordings.
StatedErrors Stated(const std::vector<PendulumRecording>& recordings);

// Steps of what has a typical size, in shares of that.
inline constexpr double kScaleStep = 1e-4;

// Those of a problem that can have an effect.
std::vector<Assumption> AssumptionsOf(const FitProblem& problem, const FitPoint& point);

// Residuals and Jacobian of a fit by its estimates and by what it takes as known. Those of
// jacobian_blocks.h know neither parts of recordings nor anything but estimates.

// One person of a recording over some of its frames.
struct DataPart {
  int recording = 0, person = 0;
  int part = 0;                 // the first horizon that holds them; as many as there are: none
  Eigen::VectorXd score;        // J'r by the estimates
  Eigen::MatrixXd information;  // J'J by them, with the robust loss's own Hessian
};

// Columns: the estimates in the order of FitPoint::Flat, then the assumptions. Rows: of each person
// of a recording, condensed (residuals/normal_equations.h), with the weight of the robust loss, so
// that J'r is the gradient of the cost; then priors, demands and pooling; then what is stated of
// each assumption.
struct RowsByHorizon {
  JacobianBlocks rows;
  std::vector<DataPart> parts;
  int num_estimates = 0;  // 0: some rollout fails
};

// horizons: frames from the first push on, ascending.
RowsByHorizon EvaluateByHorizon(const FitProblem& problem, const FitPoint& point,
                                const std::vector<Assumption>& assumptions,
                                const std::vector<int>& horizons);

}  // namespace pushid
