// residuals: what a self-force network takes over from friction and balance.
//
// The network is fed with the measured states of every recording, and the forces it answers are
// regressed on what friction and balance make theirs of: F_x, F_y on -xd, -yd (mu), F_theta on
// -e_theta and -thd (Kp_theta, Kd_theta), each for the reference person (self_force.h). A network
// whose coefficients are far from zero does what a gain could do, and the gain loses its meaning.
//   residuals: weight * [mu / 40 N s/m, Kp_theta / 1400 N m/rad, Kd_theta / 70 N m s/rad]
//   block:     the network's weights
#pragma once

#include <ceres/cost_function.h>

#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/learned_terms.h"
#include "models/options.h"
#include "residuals/cost_functions/takeover.h"

namespace pushid {

class TakeoverResidual : public ceres::CostFunction {
 public:
  // options must have a network.
  TakeoverResidual(const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
                   double weight);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  Takeover Of(const std::vector<double>& weights) const;

 private:
  using Coefficients = Eigen::Matrix<double, 3, 4>;  // of [mu, Kp, Kd] by a frame's force
  // One person of one recording.
  struct Path {
    Body body;
    std::vector<Eigen::Vector2d> deviation;  // e_theta, e_phi
    std::vector<Vector4<double>> velocity;
    std::vector<Coefficients> coefficients;
  };
  Eigen::Vector3d Regress(const double* weights, Eigen::Matrix<double, 3, Eigen::Dynamic>* jacobian,
                          double* mean_square) const;

  NetworkShape shape_;
  int num_weights_;  // a rod law's too
  double weight_;
  std::vector<Path> paths_;
};

}  // namespace pushid
