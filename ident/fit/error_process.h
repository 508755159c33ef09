// ident: how the error of a rollout grows: an error of velocity that dies out, added up.
//
//   v_t = r v_t-1 + c sqrt(1 - r^2) N(0, 1),   v_0 = 0,   r = exp(-dt / 0.3 s)
//   p_t = p_t-1 + dt v_t,                      y_t = p_t + 0.05 N(0, 1)
//
// so that y has the covariance c^2 dt^2 A K_v A' + 0.05^2 I with A the cumulative sum and
// K_v(t, u) = exp(-|t - u| / 0.3 s) - exp(-(t + u) / 0.3 s). c makes var p = 1 at 31 frames of
// 60 Hz (0.52 s): y is in units of what a recording errs by then (recording_effect.h).
//
// The process has two states, so that kriging over all frames seen is a Kalman filter: a few
// operations a frame, equal to the Cholesky factor of the covariance to rounding errors
// (error_process_test.cc). Its gains do not depend on the data: one covariance serves all axes and
// all rollouts of a person. Rejected: appending rows to the factor, which grows with every frame.
#pragma once

#include <vector>

namespace pushid {

inline constexpr double kErrorTime = 0.3;  // s, in which an error of velocity dies out

class ErrorProcess {
 public:
  explicit ErrorProcess(double dt);

  // What is known of p and v at a frame.
  struct State {
    double position = 0.0, velocity = 0.0;  // velocity: per second
  };
  // How a frame that was seen corrects the state; variance: of y less what was expected.
  struct Gains {
    double position = 0.0, velocity = 0.0, variance = 0.0;
  };

  // To the next frame; all gains are 0 where it was not seen.
  Gains Next(bool seen);

  State Predicted(const State& state) const;
  // `frames` frames on, without seeing any, p is expected to be position + Reach velocity.
  double Reach(int frames) const;
  // Of y, 1 .. frames frames on from here.
  std::vector<double> VariancesAhead(int frames) const;

 private:
  struct Covariance {
    double pp = 0.0, pv = 0.0, vv = 0.0;
  };
  Covariance Advanced(const Covariance& now) const;

  double dt_, decay_;
  double drive_ = 1.0;  // variance that v gains in a frame
  Covariance now_;
};

}  // namespace pushid
