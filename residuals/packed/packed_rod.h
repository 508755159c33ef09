// residuals: a law of the rod (models/learned_terms.h) for many people at once, step by step, and
// back: d(cost)/d(weights) of whole rollouts by the adjoint, as packed_network.h has it for self
// forces.
//
// Everybody is a column of U. Forwards, layer by layer,
//   A = tanh(W H_below + b),  H = A - tanh(b),  velocities = 0.1 m/s o H_top
// and backwards, with D = H^ (1 - A^2) from the adjoint H^ of a layer's values,
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all (people x steps),
//   b^ = -sum H^ H (A + tanh(b)): tanh' less tanh' at rest, without the difference of near equals.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "residuals/packed/packed_matrix.h"
#include "residuals/packed/packed_network.h"

namespace pushid {

class PackedRod {
 public:
  using Columns = Eigen::MatrixXd;

  PackedRod(const RodShape& shape, const VectorKernels& kernels, const PackedColumns& columns);

  // weights: of the law alone; there until the last step back.
  void Start(const double* weights);

  // inputs: u, one column for each who is active. velocities: dl/dt of each, m/s.
  void Forward(int step, const Columns& inputs, Eigen::RowVectorXd* velocities);

  // From the last step to the first: the adjoints of a step's velocities to those of its inputs.
  void Backward(int step, const Eigen::RowVectorXd& velocities, Columns* inputs);

  // After the last of these: adds d(cost)/d(weights).
  void AddWeightGradient(double* gradient);

 private:
  struct Layer : PackedLayer {
    Eigen::VectorXd rest, bias;  // tanh(b), b^
    Columns active, hidden;      // of all steps; active becomes D on the way back
  };
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // What a layer sees of all steps; what the output sees is that of the layer above the last.
  Columns& Below(size_t layer) { return layer == 0 ? inputs_ : layers_[layer - 1].hidden; }
  auto Output() const { return Eigen::Map<const Eigen::VectorXd>(weights_ + output_at_, top_); }

  PackedColumns columns_;
  const VectorKernels& kernels_;
  const double* weights_ = nullptr;
  int output_at_ = 0, top_ = RodShape::kInputs;  // of o: its first weight, its size
  std::vector<Layer> layers_;
  PackedMatrix right_;
  Columns inputs_, outputs_;  // of all steps: u, adjoints of o H
};

}  // namespace pushid
