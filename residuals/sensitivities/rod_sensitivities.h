// residuals: derivatives of a rod's velocity, beside those of the rollout
// (rollout_sensitivities.h), by hand.
//
// With v the velocity of a rod law (models/rod_law.h), S = d[q, qd]/d(columns) and the rod's own
// row s:
//   dv = (v_u u_[q,qd] + v_F F_[q,qd]) S + v_F dF_network + v_F F_p dp + v_l s + v_w dw,
//   s <- s + dt dv
// The law has one output: its derivatives by all inputs and weights are one sweep back, and what
// remains is one row times S, whatever the law's size.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "models/self_force.h"
#include "residuals/parameter_map.h"
#include "residuals/sensitivities/network_sensitivities.h"

namespace pushid {

// What one step of one person's rod saw.
struct RodStep {
  const RodLayers<double>& layers;             // after the step
  double mass;                                 // kg
  const SelfForce::Jacobian& self;             // all of the self force, whether or not it acts
  const NetworkSensitivities* network;         // after the step; null: no learned self force
  const std::vector<ColumnEntry>& parameters;  // of the person
};

class RodSensitivities {
 public:
  using States = NetworkSensitivities::States;
  using Row = Eigen::Ref<const Eigen::RowVectorXd>;

  // weights: of the whole network; weight_column: of the first of them, negative when not fitted.
  RodSensitivities(const LearnedTerms& network, const double* weights, int num_columns,
                   int weight_column);

  // dv of a step at a frame with the person's S and s; before: S one frame earlier.
  const Eigen::RowVectorXd& Velocity(const RodStep& step, const States& by_state,
                                     const States& before, const Row& rod);

 private:
  RodShape shape_;
  const double* weights_;
  int weight_column_;  // of the law's own
  Eigen::RowVectorXd own_, velocity_;
};

}  // namespace pushid
