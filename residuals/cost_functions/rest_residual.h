// residuals: a pushed person shall have settled in time, and shall not fall soon after the
// recording ends (stability). With n = frames times people, for frames first .. last - 1:
//
//   settling   r = weight / sqrt(n) [ hinge(speed / a_v - 1)            1
//                                     hinge(|angles - rest| / a_q - 1)  2 ]
//   stability  r = weight / sqrt(n) [ (angles - rest) / s_angle         2
//                                     angular rates / s_rate            2 ]
// hinge(x) = max(0, x); `rest` is the upright or initial posture the balance aims at; s: the sigmas
// of frame_residual.h.
// Settling is a demand, no pull: the people of the settling simulations (models/scene.h), from two
// seconds after the push for a second. a_v and a_q are nine tenths of what counts as settled, so
// that a demand of finite weight is met: whoever settles so is not moved at all, and needs no
// derivatives, which are rolled out only up to the last frame that has any. Stability: a
// recording's rollout continued beyond the data, with its push times a factor; it is non-zero at
// the truth of synthetic data, so it biases a fit.
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

using RestRows = Eigen::Matrix<double, Eigen::Dynamic, 8>;  // residuals by [q, qd]

struct RestProblem {
  Scene scene;
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  ResidualSigmas sigmas;
  double weight = 1.0;
  int first_frame = 0, last_frame = 0;

  // Of every residual: what makes `weight` that of a mean square.
  double Scale() const;
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

// What the two have in common: a rollout of `problem`, `rows` residuals for each frame and person.
class RestResidual : public ceres::CostFunction {
 public:
  RestResidual(RestProblem problem, int rows);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 protected:
  // The residuals of one frame and person, unweighted, and (where by_state is given) their
  // derivatives by [q, qd].
  virtual void OfState(const PendulumState<double>& state, const SelfForce& self, double* residuals,
                       RestRows* by_state) const = 0;

  const RestProblem problem_;
  const int rows_;
};

class SettlingResidual : public RestResidual {
 public:
  explicit SettlingResidual(RestProblem problem) : RestResidual(std::move(problem), 3) {}

 protected:
  void OfState(const PendulumState<double>& state, const SelfForce& self, double* residuals,
               RestRows* by_state) const override;
};

class StabilityResidual : public RestResidual {
 public:
  explicit StabilityResidual(RestProblem problem) : RestResidual(std::move(problem), 4) {}

 protected:
  void OfState(const PendulumState<double>& state, const SelfForce& self, double* residuals,
               RestRows* by_state) const override;
};

}  // namespace pushid
