// residuals: derivatives of a self-force network and of a rod that moves, carried from step to step
// beside those of the rollout (rollout_sensitivities.h), by hand.
//
// With Z = d[x; h]/d(columns) of the network's features and memory before a step, the memory after
// it has d h'/d(columns) = T Z + D: T (hidden x [x; h]) is the step linearized, all gates and
// activations multiplied out before anything touches the columns; D holds, for each weight, what
// the number it multiplies does to its own row. So a step costs one product of (hidden) rows with
// the columns, whatever the number of weights. Equations: models/self_network.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "models/self_force.h"
#include "models/self_network.h"
#include "residuals/parameter_map.h"

namespace pushid {

class NetworkSensitivities {
 public:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using ForceColumns = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>;
  using StateColumns = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;
  using States = Eigen::Ref<const StateColumns>;

  // weight_column: of the first weight; negative when the weights are not fitted.
  NetworkSensitivities(const NetworkShape& shape, const double* weights, double mass,
                       int num_columns, int weight_column);

  // state: after the step; by_state: d[q, qd]/d(columns) of the person at the step's frame.
  void Advance(const NetworkState<double>& state, const States& by_state);

  // Adds d(force)/d(columns) of the last step.
  void AddTo(ForceColumns* by_column) const;
  // Adds by_force times it.
  void AddTo(const Eigen::RowVector4d& by_force, Eigen::RowVectorXd* by_column) const;

 private:
  Eigen::VectorXd Output() const;  // what the output's weights multiply
  void AdvanceEmbedding(const NetworkState<double>& state, const States& by_state);
  // rows = step [features; hidden], or the same added: the linearized step meets the columns.
  void Carry(const Columns& step, const States& by_state, bool add, Columns* rows) const;
  // Rows of weights, `width` apart from `first` on, whose sums move their rows by `gain`: adds gain
  // times what each weight multiplies, from the row's weight `offset` on.
  template <typename Rows>
  void AddOwn(int first, int width, int offset, const Eigen::VectorXd& gain,
              const Eigen::VectorXd& multiplied, Rows rows) const;
  // The same for the block of gates that starts at row `block`; all they multiply.
  template <typename Rows>
  void AddOwnGates(const NetworkState<double>& state, int block, const Eigen::VectorXd& gain,
                   Rows rows) const;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  void Advance##Kind(const NetworkState<double>& state, const States& by_state);
  PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK

  NetworkShape shape_;
  NetworkWeights<double> weights_;
  double scale_;
  int weight_column_;
  Columns embedding_, now_, next_, cell_;  // of the embedding, the hidden units before and after a
                                           // step, the cells
  Eigen::VectorXd hidden_;                 // the last step's
};

// Derivatives of a rod's velocity, beside those of the rollout (rollout_sensitivities.h), by hand.
//
// With v the velocity of a rod law (models/learned_terms.h), S = d[q, qd]/d(columns) and the rod's
// own row s:
//   dv = (v_u u_[q,qd] + v_F F_[q,qd]) S + v_F dF_network + v_F F_p dp + v_l s + v_w dw,
//   s <- s + dt dv
// The law has one output: its derivatives by all inputs and weights are one sweep back, and what
// remains is one row times S, whatever the law's size.

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
