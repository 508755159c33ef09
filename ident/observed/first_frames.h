// ident: the first observed frames of a recording and the forecast that follows from them: the
// observed state, and the filter of unknown forces on its scene.
#pragma once

#include <array>
#include <deque>
#include <iterator>
#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_rollout.h"
#include "models/input_filter.h"
#include "models/turn.h"

namespace pushid {

// Columns: along the push, across, upwards.
Eigen::Matrix3d PushAxes(const PendulumRecording& recording);

// The filter of unknown forces (models/input_filter.h) on a recording's scene, in the axes
// and with the bodies that the model sees (problem/own_axes.h); what goes in and comes out is in
// the axes of the file.
//
// The filter that forecasts has other gains than the fit. Those of whole rollouts say where a push
// takes a person who was at rest; from a person who moves they lead away (hips of people left out
// erred by 0.23 m, a second after frame 12). Forecasts want a lean that hardly changes and a cart
// without drag: the gains in first_frames.cc, chosen once on the 32 published recordings of single
// people. They are used for people whose feet move; where feet stand, the model's own gains are.
// How much stronger and longer its tail is than the model's is learned (LearnForecasts).

class SceneFilter {
 public:
  // The recording is read for people, pushes and frame 0 alone. parameters: one set for each
  // person. noise: none of the model's own rollout. The model must outlive the filter.
  SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
              const std::optional<InputNoise>& noise, const PendulumRecording& recording);

  // These do what those of InputFilter do.
  RolloutStatus Observe(const std::vector<PendulumState<double>>& measured,
                        const std::vector<bool>& seen);
  const RolloutStatus& status() const { return filter_.status(); }
  RolloutStatus Forecast(int ahead, RolloutPath<double>* path) const;
  void Push(int person, const Vector4<double>& force);
  // The state at the last frame.
  PendulumState<double> State(int person) const { return TurnedBack(filter_.state(person)); }

 private:
  PendulumState<double> TurnedBack(PendulumState<double> state) const;

  double angle_;
  TurnedAxes to_, back_;
  InputFilter filter_;
};

// A motion that was seen to begin, and what comes of it.
//
// Two forecast:
//   physics    the rollout from frame 0, moved to where the hip was seen last and on by what is
//              left of its error of velocity v, of the last 0.05 s:
//                0.3 s (1 - exp(-h / 0.3 s)) v,   h the time ahead
//   input      the pendulum from the state that a filter with an unknown force finds
//              (SceneFilter), the force dying out; push and tail act as known
// One rule says who has the word: until a quarter of a second was seen physics, from then on
// (1 - w) physics + w input with
//   w = min(1, sqrt(T / s)),   s the time seen, T = ForecastRule::input_time.
// Where one of the two has nothing to say it is the other. Rejected: T / s, a constant w, weights
// that grow with the time ahead; a log factor on the tail as the first frames tell it, and a Kalman
// filter of the rollout's error: they forecast no better and were five times as long.
//
// An error on one axis (along the push, across, upwards) has the scale
//   exp(coefficients . [1, log(h / 0.5 s), log((s + 0.05 s) / 0.35 s), log(v + 0.05 m/s)]),
// s and h the time seen and ahead, v the mean speed to which the forecast takes the hip, and over
// that scale the quantiles of what was found, alike on both sides: the middle of every distribution
// is the forecast itself.

inline constexpr double kErrorTime = 0.3;  // s, in which an error of velocity dies out

// The hips (m) and states of all people at one frame.
struct SeenFrame {
  std::vector<Vector3<double>> hip;
  std::vector<PendulumState<double>> states;
  std::vector<bool> seen = {};  // by person; empty: all of them
  bool Sees(int person) const { return seen.empty() || seen[person]; }
};
SeenFrame FrameAt(const PendulumRecording& recording, int frame);

// Hips to come, by [person][frame ahead].
struct TwoForecasts {
  HipPaths physics, input;  // empty of one that has nothing to say
  // The rollouts from the last frame seen on.
  RolloutStatus physics_status, input_status;
  RolloutPath<double> input_path;
};

class FirstFrames {
 public:
  // The recording is read for people, pushes and frame 0 alone; it and the model must outlive the
  // object. tail: how much stronger and longer the filter's tail is than the model's.
  FirstFrames(const IdentifiedModel& model, double tail, const PendulumRecording& recording);

  // Pushes a person until the next frame, beside the recording's pushes: N, N m.
  void Push(int person, const Vector4<double>& force);
  // The next frame; the first is frame 1. It takes as long, and as much memory, however many were
  // seen.
  void Observe(const SeenFrame& frame);
  int observed() const { return observed_; }  // with frame 0
  double seconds() const;                     // after frame 0
  bool HasInput() const { return input_.has_value(); }
  // The places where hips were seen last, by person.
  std::vector<Vector3<double>> LastHips() const;

  // The next `ahead` frames.
  TwoForecasts Forecasts(int ahead, bool physics = true) const;

 private:
  // A hip that was seen, and how far it was from the rollout's.
  struct SeenHip {
    int frame;
    Vector3<double> hip, error;
  };
  HipPath Physics(int person, const RolloutPath<double>& rollout) const;
  Vector3<double> Hip(int person, const PendulumState<double>& state) const;  // of the rollout

  const PendulumRecording* recording_;
  bool rod_moves_;
  SceneFilter plain_;  // the rollout
  std::optional<SceneFilter> input_;
  int observed_ = 1;
  // By person: the last hip, and those before it until the first that is kErrorWindow older.
  std::vector<std::deque<SeenHip>> seen_;
  std::vector<Vector3<double>> beside_;  // by person: hip less the filter's, where last seen
};

// The weight w of the filter by the rule; none where nobody who is asked has anything to say.
std::optional<double> InputShare(double input_time, const HipPaths& physics, const HipPaths& input,
                                 double seconds, ForecastUse use = ForecastUse::kBoth);
HipPaths Blended(double share, const HipPaths& physics, const HipPaths& input);

// Features of the log scale, as above.
Eigen::Vector4d ScaleFeatures(double ahead, double seconds, double speed);

// The distribution of the hips to come.
class HipDistribution {
 public:
  // centre: the forecast, by person and frame ahead; from: where the hips were at the last frame
  // seen. axes: columns along the push, across, upwards.
  HipDistribution(const std::array<ErrorScale, 3>& errors, const Eigen::Matrix3d& axes,
                  HipPaths centre, const std::vector<Vector3<double>>& from, double seconds,
                  double dt);

  int num_people() const { return static_cast<int>(centre_.size()); }
  int num_frames() const { return centre_.empty() ? 0 : static_cast<int>(centre_[0].size()); }

  // frame: 0 is the first that was not seen; axis: 0 x, 1 y, 2 z.
  double Cdf(int person, int frame, int axis, double value) const;
  double Quantile(int person, int frame, int axis, double share) const;
  // Continuous ranked probability score of one value (Gneiting and Raftery 2007), m.
  double Crps(int person, int frame, int axis, double value) const;

 private:
  double Scale(int person, int frame, int axis) const { return scale_[person][frame][axis]; }

  std::array<std::vector<double>, 3> quantiles_;  // on the world's axes
  HipPaths centre_, scale_;
};

// The rule that forecasts are put together by, learned from forecasts of recordings that the
// forecasting model was not fitted to.
//
// A model flatters itself on the recordings it was fitted to, the more so the later, and what is
// learned there is wrong. So models fitted without a fold of the recordings forecast it, some
// twelve times. From these forecasts come
//   - the tail of the filter and T of the rule: of a few values those of the least mean distance of
//     the hip where both have a word;
//   - the scales and quantiles of errors: of every fold with numbers learned on the others.

// Fitted to all recordings but those held out (indices).
struct FoldModel {
  IdentifiedModel model;
  std::vector<int> held_out;
};

// folds: none where there is no model but that one, which would flatter itself: only error scales
// are then learned. Nothing where no recording stays in the model's domain.
std::optional<ForecastRule> LearnForecasts(const IdentifiedModel& model,
                                           const std::vector<PendulumRecording>& recordings,
                                           const std::vector<FoldModel>& folds, int num_threads);

// Tails of the filter over the model's that are tried.
inline constexpr double kTails[] = {1.0, 1.5, 2.2};

// One recording after its first frames, by [person][frame after them].
struct ForecastTrial {
  int fold = 0, recording = 0;
  double seconds = 0.0, dt = 0.0;
  Eigen::Matrix3d axes;
  HipPaths physics, measured;
  std::array<HipPaths, std::size(kTails)> input;  // by each tail
  std::vector<std::vector<bool>> seen;
  std::vector<Vector3<double>> from;  // hips where they were seen last
};

// The rule's tail and time of the least mean distance over trials of every fold but one (-1: of
// all).
ForecastRule LearnRule(const std::vector<ForecastTrial>& trials, int left_out = -1);
// centre: of each trial.
std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre);

}  // namespace pushid
