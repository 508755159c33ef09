// residuals: derivatives of a learned interaction (models/learned_terms.h), by hand but for its
// gate.
//
// F = 2 M g y(u, w) of each of the two gives
//   dF/ds = 2 M (g dy/du du/ds + y dg/ds),  dF/dp = 2 M y dg/dp,  dF/dw = 2 M g dy/dw
// with dy/du and dy/dw by backpropagation of the four outputs, and the gate's derivatives by Jets
// over both places and the contact's parameters.
//
// A network that is held needs no dy/dw: all pairs of a frame are then asked in one product a layer
// (packed_layers.h), four outputs of each back. One of 512-512 has its weights read once a frame
// so, and not once a pair and output.
#pragma once

#include <vector>

#include "models/learned_terms.h"
#include "models/scene_forces.h"
#include "residuals/packed/packed_layers.h"
#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {

// The gate by [q of n, q of j] and by the contact's parameters.
struct GateJacobian {
  double gate = 0.0;
  Eigen::Matrix<double, 1, 8> by_places;
  Eigen::Matrix<double, 1, kContactParameters> by_parameter;
};
GateJacobian PairGateJacobian(const PairShape& shape, const Pair& pair,
                              const ParameterSet<double>& p, const Vector4<double>& q_n,
                              const Vector4<double>& q_j);

// From derivatives by u of n, who meets j, to those by [q, qd] of n, then of j.
template <typename Rows>
Eigen::Matrix<double, Rows::RowsAtCompileTime, 16> PairInputsByStates(const Rows& by_input) {
  Eigen::Matrix<double, Rows::RowsAtCompileTime, 16> by_states;
  const auto input = [&by_input](int i, double unit) { return by_input.col(i) / unit; };
  for (int i = 0; i < 2; ++i) {
    by_states.col(i) = input(i, kPairDistance);
    by_states.col(4 + i) = input(2 + i, kNetworkSpeed);
    by_states.col(2 + i) = input(4 + 2 * i, kNetworkAngle);
    by_states.col(10 + i) = input(5 + 2 * i, kNetworkAngle);
    by_states.col(6 + i) = input(8 + i, kNetworkRate);
    by_states.col(8 + i) = -by_states.col(i);
    by_states.col(12 + i) = -by_states.col(4 + i);
    by_states.col(14 + i) = -by_states.col(6 + i);
  }
  return by_states;
}

// d(force on n, force on j) / d(weights).
using PairByWeight = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;

// What a network says of one of two people, before gate and mass.
struct PairResponse {
  Vector4<double> output;
  Eigen::Matrix<double, 4, PairShape::kInputs> by_input;
};

// Adds to the Jacobian of the other terms; by_weight: overwritten, may be null.
void AddLearnedPairJacobian(const PairShape& shape, const double* weights, const Pair& pair,
                            const ParameterSet<double>& p, const PendulumState<double>& n,
                            const PendulumState<double>& j, PairJacobian* jacobian,
                            PairByWeight* by_weight);

// All pairs of a scene by weights that are held.
class HeldPairs {
 public:
  // weights: of the interaction alone; they must outlive the object.
  HeldPairs(const PairShape& shape, const double* weights);

  // Those who act on each other at a frame; forces: prepared for it.
  void Ask(const SceneForces<double>& forces);
  // What AddLearnedPairJacobian adds, of forces.acting()[k].
  void AddTo(size_t k, const SceneForces<double>& forces, PairJacobian* jacobian) const;

 private:
  PairShape shape_;
  PackedPairs packed_;
  std::vector<GateJacobian> gates_;
  std::vector<int> first_;  // column of each pair: what n hears of j; the next: j of n
  PackedPairs::Columns inputs_, outputs_, by_input_;
};

}  // namespace pushid
