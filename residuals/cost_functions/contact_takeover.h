// residuals: what a learned interaction takes over from contact.
//
// The network is fed with the measured states of everybody who loads another, and the forces it
// answers are regressed on those of a spring of 1 N/m and of a damping of 1 N s/m (contact.h), all
// four of each person together. A network whose coefficients are far from zero does what stiffness
// and damping could do, and these lose their meaning. Loads are those of the contact's starting
// values (distance, weight of the sideways distance, height): where people touch is no matter of
// the network.
//   residuals: weight * [stiffness / 2000 N/m, damping / 100 N s/m]
//   block:     all that is learned (models/learned_terms.h)
#pragma once

#include <ceres/cost_function.h>

#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/learned_terms.h"
#include "residuals/cost_functions/takeover.h"

namespace pushid {

// For models with interaction.LearnedBesideContact().
class ContactTakeoverResidual : public ceres::CostFunction {
 public:
  // contact: whose distance, reach and height say who touches whom: a fit's starting values, so
  // that its penalty is linear in the weights, or the fitted ones to report.
  ContactTakeoverResidual(const std::vector<PendulumRecording>& recordings,
                          const ModelOptions& options, const ParameterSet<double>& contact,
                          double weight);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  ContactTakeover Of(const std::vector<double>& weights) const;

 private:
  // Two people who load each other at one frame.
  struct Touch {
    Pair pair;
    PendulumState<double> n, j;
    Eigen::Matrix<double, 2, 8> coefficients;  // of [stiffness, damping] by the forces on n and j
  };
  Eigen::Vector2d Regress(const double* weights, Eigen::Matrix<double, 2, Eigen::Dynamic>* jacobian,
                          double* mean_square) const;

  LearnedTerms learned_;
  ParameterSet<double> contact_;
  double weight_;
  std::vector<Touch> touches_;
};

}  // namespace pushid
