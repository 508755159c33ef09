// residuals: learned rods and interactions of many people at once: layers of tanh, packed as
// packed_network.h packs self forces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "residuals/packed/packed_matrix.h"
#include "residuals/packed/packed_network.h"

namespace pushid {

// A law of the rod (models/learned_terms.h) for many people at once, step by step, and
// back: d(cost)/d(weights) of whole rollouts by the adjoint, as packed_network.h has it for self
// forces.
//
// Everybody is a column of U. Forwards, layer by layer,
//   A = tanh(W H_below + b),  H = A - tanh(b),  velocities = 0.1 m/s o H_top
// and backwards, with D = H^ (1 - A^2) from the adjoint H^ of a layer's values,
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all (people x steps),
//   b^ = -sum H^ H (A + tanh(b)): tanh' less tanh' at rest, without the difference of near equals.
// Of an ldp law, A = H = max(0, W H_below + b), D = H^ where A > 0, and b^ = sum D.
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
  const bool biased_;
  const double* weights_ = nullptr;
  int output_at_ = 0, top_;  // of o: its first weight, its size
  std::vector<Layer> layers_;
  PackedMatrix right_;
  Columns inputs_, outputs_;  // of all steps: u, adjoints of o H
};

// The network of a learned interaction (models/learned_terms.h) for many people at once,
// step by step, and back: d(cost)/d(weights) of whole rollouts by the adjoint, as
// packed_network.h has it for self forces.
//
// Each of two people who touch is a column of U, so that a step has as many columns as it has
// contacts, twice. Forwards, layer by layer with H_0 = U,
//   H_i = tanh(W_i H_(i-1) + b_i),  Y = O H_last + c
// and backwards, with D = H^ (1 - H^2) from the adjoint H^ of a layer's values (D = Y^ of the
// last),
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all columns,   b^ = sum D.
// H and D of every step are kept: 16 bytes a unit and column. Of an ldp network max(0, .) stands
// for tanh.

class PackedPairs {
 public:
  using Columns = Eigen::MatrixXd;

  PackedPairs(const PairShape& shape, const VectorKernels& kernels);

  // Before the first step; weights: of the interaction alone, there until the last step back.
  void Start(const double* weights);

  // The next step. inputs: u, a column for each, maybe none. outputs: y before gate and mass, 4 x
  // as many.
  void Forward(const Columns& inputs, Columns* outputs);

  // From the last step to the first: the adjoints of a step's outputs to those of its inputs.
  void Backward(int step, const Columns& outputs, Columns* inputs);

  // After the last step back: adds d(cost)/d(weights).
  void AddWeightGradient(double* gradient);

 private:
  // The last of them is [O c].
  struct Layer : PackedLayer {
    Columns values, back;  // of all steps: H (Y of the last), D
  };

  // What a layer sees of all steps.
  Columns& Below(size_t layer) { return layer == 0 ? inputs_ : layers_[layer - 1].values; }
  // Slopes of the hidden units' activation, given their values.
  template <typename Values>
  Eigen::ArrayXXd Slopes(const Values& values) const {
    if (rectified_) return (values.array() > 0.0).template cast<double>();
    return 1.0 - values.array().square();
  }
  bool IsOutput(size_t layer) const { return layer + 1 == layers_.size(); }
  auto At(Columns& of, int step) const {
    return of.middleCols(first_[step], first_[step + 1] - first_[step]);
  }
  // Room for all columns of the steps so far.
  void Grow();

  const VectorKernels& kernels_;
  const bool rectified_;
  const double* weights_ = nullptr;
  std::vector<Layer> layers_;
  std::vector<int> first_ = {0};  // column of each step, and the total
  PackedMatrix right_;
  Columns inputs_;  // of all steps
};

}  // namespace pushid
