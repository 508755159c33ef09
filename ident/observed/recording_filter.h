// ident: one recording seen frame by frame: what it tells of its effect, and of what comes
// (RecordingEffect, below).
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
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_rollout.h"
#include "models/input_filter.h"
#include "models/turn.h"

namespace pushid {

// How recordings differ from what the same push does to the mean person, and how much the
// first frames tell of it.
//
// Every recording i has its own log factor b on the tail; all else is held at the fit (freed
// together with it, parameters run away on real recordings):
//
//   y = f(b) + s g a e,   b ~ N(0, w^2)
//
// y: the hip; f: the rollout; g: the speed that the push gives the person with its tail, over 1
// m/s; a: 1 along the push, 0.3 across and upwards; e: recording_filter.h on every axis. w and s by
// maximum marginal likelihood (expectation maximization) over fixed nodes of b: one rollout a node,
// then no more. b acts where one person alone is pushed and the push has a tail. People who touch
// have e alone: b changed nothing there (README.md of ident/prediction).
//
// After k frames b has the posterior over the nodes; its mean makes one rollout, to which the
// expectation of e is added. (The mean, not the mode: the posterior is skewed.) That is one of the
// two forecasts that are put together (first_frames.h).

inline constexpr int kEffectNodes = 33;
inline constexpr double kWidestEffect = 1.6;

inline constexpr double EffectNode(int node) {
  return kWidestEffect * (2.0 * node / (kEffectNodes - 1) - 1.0);
}

// Weights of the nodes that sum to 1; misfit: -2 s^2 log likelihood of each, infinite where its
// rollout left the domain.
std::vector<double> EffectWeights(const std::vector<double>& misfit, double spread,
                                  double error_scale);

struct EffectEstimate {
  double mean = 0.0, error = 0.0;
};
// Of weighted nodes.
EffectEstimate MeanEffect(const std::vector<double>& weights);

// Whether b acts on a recording.
bool EffectActs(const ModelOptions& model, const PendulumRecording& recording);

// After the trajectories; nothing where the model has no tail, or no recording stays in its domain.
std::optional<RecordingEffect> FitRecordingEffect(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings,
                                                  int num_threads = 1);

// How the error of a rollout grows: an error of velocity that dies out, added up.
//
//   v_t = r v_t-1 + c sqrt(1 - r^2) N(0, 1),   v_0 = 0,   r = exp(-dt / 0.3 s)
//   p_t = p_t-1 + dt v_t,                      y_t = p_t + 0.05 N(0, 1)
//
// so that y has the covariance c^2 dt^2 A K_v A' + 0.05^2 I with A the cumulative sum and
// K_v(t, u) = exp(-|t - u| / 0.3 s) - exp(-(t + u) / 0.3 s). c makes var p = 1 at 31 frames of
// 60 Hz (0.52 s): y is in units of what a recording errs by then.
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

// The filter of unknown forces (models/input_filter.h) on a recording's scene, in the axes
// and with the bodies that the model sees (problem/own_axes.h); what goes in and comes out is in
// the axes of the file.
//
// The filter that forecasts has other gains than the fit. Those of whole rollouts say where a push
// takes a person who was at rest; from a person who moves they lead away (hips of people left out
// erred by 0.23 m, a second after frame 12). Forecasts want a lean that hardly changes and a cart
// without drag: the gains in recording_filter.cc, chosen once on the 32 published recordings of
// single people. They are used for people whose feet move; where feet stand, the model's own gains
// are. The tail's strength and time are learned again for it (learn_forecasts.h).

class SceneFilter {
 public:
  // Of the recording only people, pushes and frame 0 are looked at. parameters: one set for each
  // person. The model must outlive the filter. frames: how far to look, in all.
  SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
              const InputNoise& noise, const PendulumRecording& recording, int frames);

  // As InputFilter has them.
  RolloutStatus Observe(const std::vector<PendulumState<double>>& measured,
                        const std::vector<bool>& seen);
  const RolloutStatus& status() const { return filter_.status(); }
  RolloutStatus Forecast(RolloutPath<double>* path) const;
  // At the last frame.
  PendulumState<double> State(int person) const { return TurnedBack(filter_.state(person)); }

 private:
  PendulumState<double> TurnedBack(PendulumState<double> state) const;

  double angle_;
  TurnedAxes to_, back_;
  InputFilter filter_;
};

// The filter that forecasts; none of models with networks, whose memory no measurement corrects.
std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, const ForecastRule& rule,
                                          const PendulumRecording& recording, int frames);

}  // namespace pushid
