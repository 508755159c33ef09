// residuals: a pushed person shall settle, and shall not fall soon after
// the recording ends (stability).
//
//   r = weight * sqrt(1 / (frames people)) [ cart velocity / s_velocity   2 (settling only)
//                                   (angles - rest) / s_angle    2
//                                   angular rates / s_rate       2 ]   for frames first .. last - 1
// in the sigmas of frame_residual.h; `rest` is the upright or initial posture the balance aims at.
// Settling: the people of the settling simulations (models/scene.h), frames 110 to 180 (1.8 to 3 s
// at 60 Hz). Stability: a recording's rollout continued beyond the data, with its push times a
// factor. Both are non-zero at the truth of synthetic data, so they bias a fit: leave them out
// where recovery or coverage is measured.
#pragma once

#include <ceres/cost_function.h>

#include "datasets/loading/pendulum_recording.h"
#include "residuals/frame_residual.h"
#include "residuals/parameter_map.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// How much longer and harder than its recording a stability rollout is.
inline constexpr int kFramesPastTheEnd = 40;
inline constexpr double kStrongerPush = 1.4;

struct RestProblem {
  Scene scene;
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  ResidualSigmas sigmas;
  double weight = 1.0;
  int first_frame = 110, last_frame = 180;
  bool penalize_velocity = true;

  int residuals_per_frame() const { return penalize_velocity ? 6 : 4; }
};

// A settling simulation (models/scene.h) of people with the shared parameters, or with those of
// `unit` (whose deviations are then the second block).
RestProblem SettlingProblem(const Scene& scene, const ModelOptions& options,
                            const ParameterMap& map, const ResidualSigmas& sigmas, double weight,
                            const std::string& unit = "");

// The recording rolled out `extra_frames` past its end, its push multiplied by `factor`.
RestProblem StabilityProblem(const PendulumRecording& recording, double factor, int extra_frames,
                             const ModelOptions& options, const ParameterMap& map,
                             const ResidualSigmas& sigmas, double weight);

class RestResidual : public ceres::CostFunction {
 public:
  explicit RestResidual(RestProblem problem);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  RestProblem problem_;
};

}  // namespace pushid
