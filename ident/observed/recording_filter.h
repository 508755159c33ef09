// ident: one recording seen frame by frame: what it tells of its effect, and of what comes
// (recording_effect.h has the model).
//
//   RecordingFilter filter(model, recording, recording.num_frames());
//   for (int t = 1; t < k; ++t) filter.Observe(HipsAt(recording, t));
//   const EffectEstimate b = filter.Effect(*model.recording_effect);
//   filter.ForecastOf(hips of a rollout with b.mean);
//
// All nodes are rolled out once; a frame then costs two multiplications a node and axis, and its
// sums are never looked at again.
#pragma once

#include <array>
#include <vector>

#include "ident/model/model_rollout.h"
#include "ident/observed/recording_effect.h"

namespace pushid {

// How the error of a rollout grows: an error of velocity that dies out, added up.
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

// Columns: along the push, across, upwards.
Eigen::Matrix3d PushAxes(const PendulumRecording& recording);

// Where people's hips are at one frame.
struct SeenHips {
  std::vector<Vector3<double>> hip;  // m
  std::vector<bool> seen = {};       // by person; empty: all of them
  bool Sees(int person) const { return seen.empty() || seen[person]; }
};
SeenHips HipsAt(const PendulumRecording& recording, int frame);

// Hips to come as a mixture of normal distributions, a component for each node, on the axes of
// Axes(): by [person][frame].
struct MixturePoint {
  std::vector<Vector3<double>> mean;  // of the components
  Vector3<double> deviation;          // the same for all of them
};

class RecordingFilter {
 public:
  // Of the recording only people, pushes and frame 0 are looked at. `frames`: how far to look.
  RecordingFilter(const IdentifiedModel& model, const PendulumRecording& recording, int frames);

  // The next frame; the first is frame 1. Not more than there are.
  void Observe(const SeenHips& frame);
  int observed() const { return observed_; }  // with frame 0
  int frames() const { return frames_; }
  double seconds() const { return (observed_ - 1) * dt_; }

  bool acts() const { return nodes_.size() > 1; }  // of the effect
  bool ok() const;                                 // whether any node stayed in the domain
  const std::vector<double>& misfit() const { return misfit_; }
  int residuals() const { return residuals_; }  // that each misfit is a sum over
  double error_unit() const { return unit_; }   // g
  // Columns: along the push, across, upwards.
  const Eigen::Matrix3d& Axes() const { return axes_; }

  // Before anything is seen both are exactly the prior's.
  EffectEstimate Effect(const RecordingEffect& effect) const;
  // The frames to come, of a rollout over all frames and what is left of its error.
  HipPaths ForecastOf(const HipPaths& rollout) const;
  // By [person][frame - observed()]; weights as in EffectWeights.
  std::vector<std::vector<MixturePoint>> Mixture(const RecordingEffect& effect,
                                                 std::vector<double>* weights) const;

 private:
  using Axis3 = std::array<ErrorProcess::State, 3>;
  struct Node {
    HipPaths hip;  // empty after a failure
    std::vector<Axis3> error;
  };
  struct Seen {
    SeenHips hips;
    std::vector<ErrorProcess::Gains> gains;  // by person
  };
  // On the axes, in units of y.
  Vector3<double> Scaled(const Vector3<double>& error) const;
  // One person's error after all frames seen; misfit may be null.
  void Update(const Vector3<double>& error, const ErrorProcess::Gains& gains, Axis3* state,
              double* misfit) const;

  double dt_, unit_;
  int frames_, observed_ = 1, residuals_ = 0;
  Eigen::Matrix3d axes_;
  std::vector<ErrorProcess> process_;  // by person
  std::vector<Node> nodes_;
  std::vector<double> misfit_;
  std::vector<Seen> seen_;
};

}  // namespace pushid
