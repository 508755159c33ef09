// ident: a motion that was seen to begin, and what comes of it.
//
// Two forecast:
//   physics    the rollout from frame 0, moved to where the hip was seen last and on by what is
//              left of its error of velocity v, of the last 0.05 s:
//                0.3 s (1 - exp(-h / 0.3 s)) v,   h the time ahead
//   input      the pendulum from the state that a filter with an unknown force finds
//              (scene_filter.h), the force dying out; push and tail act as known
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
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ident/model/model_rollout.h"
#include "ident/observed/scene_filter.h"

namespace pushid {

inline constexpr double kErrorTime = 0.3;  // s, in which an error of velocity dies out

// Everybody at one frame.
struct SeenFrame {
  SeenHips hips;
  std::vector<PendulumState<double>> states;
};
SeenFrame FrameAt(const PendulumRecording& recording, int frame);

// Hips to come, by [person][frame ahead].
struct TwoForecasts {
  HipPaths physics, input;  // empty of one that has nothing to say
  // What the filter with an unknown force says of all frames.
  RolloutStatus input_status;
  RolloutPath<double> input_path;
};

class FirstFrames {
 public:
  // Only people, pushes and frame 0 of the recording are read; it and the model must outlive
  // the object. rollout: the model's hips over as many frames as are looked at; empty: it left the
  // domain. tail: of ForecastFilter.
  FirstFrames(const IdentifiedModel& model, double tail, const PendulumRecording& recording,
              HipPaths rollout, int frames);

  // The next frame; the first is frame 1. Not more than there are.
  void Observe(SeenFrame frame);
  int observed() const { return static_cast<int>(seen_.size()) + 1; }  // with frame 0
  int frames() const { return frames_; }
  double seconds() const;  // after frame 0
  bool HasInput() const { return input_.has_value(); }
  const std::vector<SeenFrame>& seen() const { return seen_; }  // from frame 1 on
  // Where hips were seen last, by person.
  std::vector<Vector3<double>> LastHips() const;

  TwoForecasts Forecasts() const;

 private:
  int LastSeen(int person, int until) const;
  Vector3<double> HipAt(int person, int frame) const;
  HipPath Physics(int person) const;

  const PendulumRecording* recording_;
  HipPaths rollout_;
  int frames_;
  std::optional<SceneFilter> input_;
  std::vector<SeenFrame> seen_;
  std::vector<Vector3<double>> beside_;  // by person: hip less the filter's, where last seen
};

// The weight w of the filter by the rule; none where nobody who is asked has anything to say.
std::optional<double> InputShare(double input_time, const HipPaths& physics, const HipPaths& input,
                                 double seconds, ForecastUse use = ForecastUse::kBoth);
HipPaths Blended(double share, const HipPaths& physics, const HipPaths& input);

// Features of the log scale, as above.
Eigen::Vector4d ScaleFeatures(double ahead, double seconds, double speed);

// Where hips will be.
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

}  // namespace pushid
