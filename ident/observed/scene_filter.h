// ident: the filter of unknown forces (models/input_filter.h) on a recording's scene, in the axes
// and with the bodies that the model sees (problem/own_axes.h); what goes in and comes out is in
// the axes of the file.
//
// The filter that forecasts has other gains than the fit. Those of whole rollouts say where a push
// takes a person who was at rest; from a person who moves they lead away (hips of people left out
// erred by 0.23 m, a second after frame 12). Forecasts want a lean that hardly changes and a cart
// without drag: the gains in scene_filter.cc, chosen once on the 32 published recordings of single
// people. They are used for people whose feet move; where feet stand, the model's own gains are.
// The tail's strength and time are learned again for it (learn_forecasts.h).
#pragma once

#include <optional>
#include <vector>

#include "ident/model/model_rollout.h"
#include "models/input_filter.h"
#include "models/turn.h"

namespace pushid {

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
  double Deviance() const { return filter_.Deviance(); }
  // At the last frame.
  PendulumState<double> State(int person) const { return TurnedBack(filter_.state(person)); }
  // Unknown, on x, y, theta and phi, N and N m; and its standard deviation.
  Vector4<double> Force(int person) const;
  Vector4<double> ForceDeviation(int person) const;

 private:
  PendulumState<double> TurnedBack(PendulumState<double> state) const;

  double angle_;
  TurnedAxes to_, back_;
  InputFilter filter_;
};

// The filter that forecasts; none of models with networks, whose memory no measurement corrects.
std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, const ForecastStack& stack,
                                          const PendulumRecording& recording, int frames);
// The filter that says which force acted beside those of the model, with its own gains and tail.
std::optional<SceneFilter> UnknownForceFilter(const IdentifiedModel& model, const InputNoise& noise,
                                              const PendulumRecording& recording, int frames);

}  // namespace pushid
