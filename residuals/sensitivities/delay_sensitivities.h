// residuals: derivatives of what control perceives (models/reaction_delay.h), and of the forces
// that act on it.
//
// With S(t) = d [q, qd] / d columns and w_i the weights of a delayed state,
//   S_p = s S(t) + (1 - s) sum_i w_i S(t_i)  row by row, s the passive shares,
// and beside it the derivatives by the delays and by the shares, which go into those by parameter.
#pragma once

#include "models/scene_forces.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// Of one person at one frame.
class PerceivedSensitivities {
 public:
  // Prepared for a rollout of so many columns.
  explicit PerceivedSensitivities(int num_columns);

  void Update(const ModelOptions& options, const ParameterSet<double>& p,
              const DelayedPlaces<double>& delayed, const RolloutPath<double>& path,
              const RolloutSensitivities& sensitivities, int frame, int person);

  // Adds what the forces (or the feet after the step) change by through what was perceived:
  // by_ankle and by_step are their derivatives by the two perceived states, over [q, qd].
  void AddTo(const Eigen::Matrix<double, 4, 8>& by_ankle,
             const Eigen::Matrix<double, 4, 8>& by_step,
             Eigen::Ref<Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>> by_column) const;
  // The same through the delays and the shares.
  void AddParameters(const Eigen::Matrix<double, 4, 8>& by_ankle,
                     const Eigen::Matrix<double, 4, 8>& by_step,
                     Eigen::Matrix<double, 4, kNumParameters>* by_parameter) const;

 private:
  using Block = RolloutSensitivities::Block;
  using State = Eigen::Matrix<double, 8, 1>;
  Block ankle_, step_;
  State ankle_by_delay_, step_by_delay_, by_stiffness_share_, by_damping_share_;
  Parameter step_delay_ = kReactionDelay;
  bool steps_ = true;  // feet that hold ask for no cart
};

}  // namespace pushid
