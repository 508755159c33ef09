// residuals: the network of a learned interaction (models/learned_terms.h) for many people at once,
// step by step, and back: d(cost)/d(weights) of whole rollouts by the adjoint, as
// packed_network.h has it for self forces.
//
// Each of two people who touch is a column of U, so that a step has as many columns as it has
// contacts, twice. Forwards, layer by layer with H_0 = U,
//   H_i = tanh(W_i H_(i-1) + b_i),  Y = O H_last + c
// and backwards, with D = H^ (1 - H^2) from the adjoint H^ of a layer's values (D = Y^ of the
// last),
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all columns,   b^ = sum D.
// H and D of every step are kept: 16 bytes a unit and column.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "residuals/packed/packed_matrix.h"

namespace pushid {

class PackedPairs {
 public:
  using Columns = Eigen::MatrixXd;

  PackedPairs(const PairShape& shape, const VectorKernels& kernels);

  // Before the first step; weights: of the interaction alone, there until the last step back.
  void Start(const double* weights);
  // All steps, for others by the same weights.
  void Forget() { first_ = {0}; }

  // The next step. inputs: u, a column for each, maybe none. outputs: y before gate and mass, 4 x
  // as many.
  void Forward(const Columns& inputs, Columns* outputs);

  // From the last step to the first: the adjoints of a step's outputs to those of its inputs.
  void Backward(int step, const Columns& outputs, Columns* inputs);

  // Instead of that, of the last step forwards: d(outputs)/d(inputs). Four columns for each of the
  // step's, one for each of its outputs.
  void Linearize(Columns* by_input);

  // After the last step back: adds d(cost)/d(weights).
  void AddWeightGradient(double* gradient);

 private:
  // The last of them is [O c].
  struct Layer : PackedLayer {
    Columns values, back;  // of all steps: H (Y of the last), D
  };

  // What a layer sees of all steps.
  Columns& Below(size_t layer) { return layer == 0 ? inputs_ : layers_[layer - 1].values; }
  bool IsOutput(size_t layer) const { return layer + 1 == layers_.size(); }
  auto At(Columns& of, int step) const {
    return of.middleCols(first_[step], first_[step + 1] - first_[step]);
  }
  // Room for all columns of the steps so far.
  void Grow();

  const VectorKernels& kernels_;
  const double* weights_ = nullptr;
  std::vector<Layer> layers_;
  std::vector<int> first_ = {0};  // column of each step, and the total
  PackedMatrix right_;
  Columns inputs_;  // of all steps
};

}  // namespace pushid
