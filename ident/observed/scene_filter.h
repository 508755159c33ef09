// ident: what was seen of a recording, and the filter of unknown forces on its scene.
#pragma once

#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "models/input_filter.h"
#include "models/turn.h"

namespace pushid {

// Columns: along the push, across, upwards.
Eigen::Matrix3d PushAxes(const PendulumRecording& recording);

// Where people's hips are at one frame.
struct SeenHips {
  std::vector<Vector3<double>> hip;  // m
  std::vector<bool> seen = {};       // by person; empty: all of them
  bool Sees(int person) const { return seen.empty() || seen[person]; }
};
SeenHips HipsAt(const PendulumRecording& recording, int frame);

// The filter of unknown forces (models/input_filter.h) on a recording's scene, in the axes
// and with the bodies that the model sees (problem/own_axes.h); what goes in and comes out is in
// the axes of the file.
//
// The filter that forecasts has other gains than the fit. Those of whole rollouts say where a push
// takes a person who was at rest; from a person who moves they lead away (hips of people left out
// erred by 0.23 m, a second after frame 12). Forecasts want a lean that hardly changes and a cart
// without drag: the gains in scene_filter.cc, chosen once on the 32 published recordings of single
// people. They are used for people whose feet move; where feet stand, the model's own gains are.
// How much stronger and longer its tail is than the model's is learned (learn_forecasts.h).

class SceneFilter {
 public:
  // Only people, pushes and frame 0 of the recording are read. parameters: one set for each
  // person. The model must outlive the filter. frames: how far to look, in all.
  SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
              const InputNoise& noise, const PendulumRecording& recording, int frames);

  // These do what those of InputFilter do.
  RolloutStatus Observe(const std::vector<PendulumState<double>>& measured,
                        const std::vector<bool>& seen);
  const RolloutStatus& status() const { return filter_.status(); }
  RolloutStatus Forecast(RolloutPath<double>* path) const;
  // The state at the last frame.
  PendulumState<double> State(int person) const { return TurnedBack(filter_.state(person)); }

 private:
  PendulumState<double> TurnedBack(PendulumState<double> state) const;

  double angle_;
  TurnedAxes to_, back_;
  InputFilter filter_;
};

// The filter that forecasts, its tail so much stronger and longer than the model's; none of models
// with networks, whose memory no measurement corrects.
std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, double tail,
                                          const PendulumRecording& recording, int frames);

}  // namespace pushid
