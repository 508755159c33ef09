// ident: a motion that was seen to begin, and what each forecaster says of the rest.
//
//   physics    the rollout by what the push and the recording's effect say, and on it what is left
//              of its error (recording_filter.h)
//   input      the pendulum from the state that a filter with an unknown force finds
//              (recording_filter.h), the force dying out; push and tail act as known
//   kinematic  a quadratic through what was seen last, fading (GoesOnAccelerating)
//   velocity   the last velocity
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ident/model/model_rollout.h"
#include "ident/observed/recording_filter.h"

namespace pushid {

// Hips that go on as they were seen to go, without any model.

// What was seen of one hip, frame 0 at least; unseen frames are ignored.
struct SeenPath {
  HipPath hip;
  std::vector<bool> seen;
};
int LastSeen(const SeenPath& path);

// From the last frame on: where it was seen last, and on with the mean velocity of so many seconds
// before (one frame at least). One frame alone stays where it is.
HipPath GoesOn(const SeenPath& path, double seconds, double dt, int frames_ahead);

// A quadratic through the last 0.23 s, whose acceleration fades with 0.25 s and whose velocity with
// 1 s.
HipPath GoesOnAccelerating(const SeenPath& path, double dt, int frames_ahead);

// Everybody at one frame.
struct SeenFrame {
  SeenHips hips;
  std::vector<PendulumState<double>> states;
};
SeenFrame FrameAt(const PendulumRecording& recording, int frame);

// Hips to come by forecaster; empty of one that is not available.
using ForecastsOfAll = std::array<HipPaths, kNumForecasters>;

// What the filter with an unknown force says of all frames.
struct InputForecast {
  RolloutStatus status;
  RolloutPath<double> path;
};

class FirstFrames {
 public:
  // Of the recording only people, pushes and frame 0 are looked at; it and the model must outlive
  // the object. frames: how far to look, in all.
  FirstFrames(const IdentifiedModel& model, const ForecastStack& stack,
              const PendulumRecording& recording, int frames);

  // The next frame; the first is frame 1. Not more than there are.
  void Observe(SeenFrame frame);
  int observed() const { return filter_.observed(); }  // with frame 0
  int frames() const { return filter_.frames(); }
  double seconds() const { return filter_.seconds(); }  // after frame 0
  const RecordingFilter& filter() const { return filter_; }
  bool HasInput() const { return input_.has_value(); }
  const std::vector<SeenFrame>& seen() const { return seen_; }  // from frame 1 on
  // Where hips were seen last, by person.
  std::vector<Vector3<double>> LastHips() const;

  // rollout: the model's hips with the effect, over all frames; empty: it left the domain. input:
  // may be null.
  ForecastsOfAll Forecasts(const HipPaths& rollout, InputForecast* input = nullptr) const;

 private:
  HipPaths InputHips(InputForecast* forecast) const;

  const PendulumRecording* recording_;
  RecordingFilter filter_;
  std::optional<SceneFilter> input_;
  std::vector<SeenFrame> seen_;
  std::vector<SeenPath> paths_;          // by person
  std::vector<Vector3<double>> beside_;  // by person: hip less the filter's, where last seen
};

}  // namespace pushid
