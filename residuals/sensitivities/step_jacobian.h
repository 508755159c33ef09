// residuals: one step of everybody with its derivatives by each person's own state: the analytic
// twin of DualStep (models/pendulum_filter.h), chained from the pieces that rollouts' sensitivities
// are chained from, at a quarter of its cost.
#pragma once

#include <vector>

#include "models/rollout.h"

namespace pushid {

class StepJacobian {
 public:
  // All arguments must outlive the object. For models whose state is place and velocity.
  StepJacobian(const Scene& scene, const ModelOptions& options,
               const std::vector<ParameterSet<double>>& parameters)
      : scene_(scene), options_(options), forces_(scene, options, parameters) {}

  void Begin(const std::vector<PendulumState<double>>& states);
  Vector4<double> Velocity(int frame, int person, Eigen::Matrix<double, 4, 8>* by_state);

 private:
  const Scene& scene_;
  const ModelOptions& options_;
  SceneForces<double> forces_;
};

}  // namespace pushid
