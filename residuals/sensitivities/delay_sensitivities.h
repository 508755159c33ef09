// residuals: derivatives of what control perceives (models/reaction_delay.h).
//
// With S(t) = d [q, qd] / d columns and w_i the weights of a delayed state,
//   S_p = s S(t) + (1 - s) sum_i w_i S(t_i)  row by row, s the passive shares,
// and in the columns of the delays and of the shares, what these change.
#pragma once

#include "models/scene_forces.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// Of one person at one frame.
class PerceivedSensitivities {
 public:
  // Prepared for a rollout of so many columns.
  explicit PerceivedSensitivities(int num_columns);

  // entries: of the person's parameters.
  void Update(const ModelOptions& options, const ParameterSet<double>& p,
              const std::vector<ColumnEntry>& entries, const DelayedPlaces<double>& delayed,
              const RolloutPath<double>& path, const RolloutSensitivities& sensitivities, int frame,
              int person);

  // Of [q, qd] as ankles and steps perceive it, by the columns. Feet that hold ask for no steps.
  const RolloutSensitivities::Block& ankle() const { return ankle_; }
  const RolloutSensitivities::Block& step() const { return step_; }

 private:
  RolloutSensitivities::Block ankle_, step_;
};

}  // namespace pushid
