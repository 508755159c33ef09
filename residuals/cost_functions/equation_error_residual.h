// residuals: equation error, the start of a fit.
//
// Instead of rolling out, the model's net force is compared with inverse dynamics at the measured
// states:
//   r = (F_net(q, qd; p) - (M qdd + C + G)) / scale    rows x, y, theta, phi; frames 0 .. T - 1
//   scale = M s_a for the cart rows, m l^2 s_a / l for the angle rows (s_a = 1 m/s^2),
// with q, qd, qdd from Savitzky-Golay smoothing. Linear in every gain, no rollout, hence one basin;
// but noise in the states biases it, so it starts a fit and never reports one.
#pragma once

#include <ceres/cost_function.h>

#include "datasets/loading/pendulum_recording.h"
#include "models/options.h"
#include "models/skeleton_mapping.h"
#include "residuals/parameter_map.h"

namespace pushid {

inline constexpr int kEquationErrorWindow = 11;  // frames; shorter ones leave too much noise in qdd

class EquationErrorResidual : public ceres::CostFunction {
 public:
  // recording must outlive the residual. Blocks as in BlockLayout.
  EquationErrorResidual(const PendulumRecording& recording, const ModelOptions& options,
                        const ParameterMap& map, int window = kEquationErrorWindow);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  const PendulumRecording& recording_;
  ModelOptions options_;
  ParameterMap map_;
  BlockLayout layout_;
  // Smoothed, with the force that inverse dynamics asks for.
  struct Measured {
    PosedPendulum<double> state;
    Vector4<double> force;
  };
  std::vector<std::vector<Measured>> measured_;  // [person][frame]
};

}  // namespace pushid
