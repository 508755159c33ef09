// residuals: derivatives of a self-force network, carried from step to step beside those of the
// rollout (rollout_sensitivities.h), by hand.
//
// With Z = d[x; h]/d(columns) of the network's features and memory before a step, each row of
// weights w adds w Z to its sum, and the column of each of its own weights the number that weight
// multiplies; activations scale rows. One product of (rows of weights) x (columns) a step, whatever
// the number of weights. Equations: models/self_network.h.
#pragma once

#include <Eigen/Core>

#include "models/self_network.h"

namespace pushid {

class NetworkSensitivities {
 public:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
  using States = Eigen::Ref<const Eigen::Matrix<double, 8, Eigen::Dynamic>>;
  using Row = Eigen::Ref<const Eigen::RowVectorXd>;

  // weight_column: of the first weight; negative when the weights are not fitted.
  NetworkSensitivities(const NetworkShape& shape, const double* weights, double mass,
                       int num_columns, int weight_column);

  // state: after the step; by_state: d[q, qd]/d(columns) of the person at the step's frame; rod:
  // d(l)/d(columns) there, empty where the rod is constant.
  void Advance(const NetworkState<double>& state, const States& by_state,
               const Row& rod = Eigen::RowVectorXd());

  // Adds d(force)/d(columns) of the last step.
  void AddTo(Eigen::Matrix<double, 4, Eigen::Dynamic>* by_column) const;
  // Adds by_force times it.
  void AddTo(const Eigen::RowVector4d& by_force, Eigen::RowVectorXd* by_column) const;

 private:
  void AdvanceFeatures(const NetworkState<double>& state, const States& by_state, const Row& rod);
  // Adds, for each row of a matrix of weights that starts at `first`, the numbers its weights
  // multiply.
  void AddOwn(int first, int width, int offset, const Eigen::VectorXd& multiplied,
              Columns* rows) const;
  void AdvanceMlp(const NetworkState<double>& state);
  void AdvanceGru(const NetworkState<double>& state);
  void AdvanceLstm(const NetworkState<double>& state);
  void SumGates(const NetworkState<double>& state);

  NetworkShape shape_;
  NetworkWeights<double> weights_;
  double scale_;
  int weight_column_;
  Columns z_;  // of [features; hidden]
  Columns gates_, candidates_, recurrent_, cell_;
  Columns output_;  // of the outputs
};

}  // namespace pushid
