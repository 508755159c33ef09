// residuals: learned rods and interactions (models/learned_terms.h) of many people at once, step by
// step, and back: dense layers, packed as packed_network.h packs self forces, with
// d(cost)/d(weights) of whole rollouts by the adjoint.
//
// Everybody, or each of two people who touch, is a column of U. Forwards, with H_0 = U,
//   H_i = tanh(W_i H_(i-1) + b_i), of a law of the rod less tanh(b_i);  Y = O H_last + c
// and backwards, with D = H^ tanh' from the adjoint H^ of a layer's values (D = Y^ of the last),
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all columns,   b^ = sum D,
// of a law of the rod b^ = -sum H^ H (H + 2 tanh(b)): tanh' less tanh' at rest, without the
// difference of near equals. H and D of every step are kept: 16 bytes a unit and column. Of LDP's
// networks max(0, .) stands for tanh.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "residuals/packed/packed_matrix.h"

namespace pushid {

class PackedLayers {
 public:
  using Columns = Eigen::MatrixXd;

  // Y of the first is [dl/dt] over kRodSpeed, of the second what is before gate and mass.
  PackedLayers(const RodShape& shape, const VectorKernels& kernels);
  PackedLayers(const PairShape& shape, const VectorKernels& kernels);

  // Before the first step; weights: of these layers alone, there until the last step back.
  void Start(const double* weights);

  // The next step. inputs: u, a column for each, maybe none.
  void Forward(const Columns& inputs, Columns* outputs);

  // From the last step to the first: the adjoints of a step's outputs to those of its inputs.
  void Backward(int step, const Columns& outputs, Columns* inputs);

  // After the last step back: adds d(cost)/d(weights).
  void AddWeightGradient(double* gradient);

 private:
  // The last of them is [O c].
  struct Layer : PackedLayer {
    Eigen::VectorXd rest, bias;  // tanh(b), where it is taken off; b^
    Columns values, back;        // of all steps: H (Y of the last), D
  };

  PackedLayers(int inputs, const std::vector<int>& hidden, int outputs, bool rectified,
               bool from_rest, bool output_bias, const VectorKernels& kernels);
  // What a layer sees of all steps.
  Columns& Below(size_t layer) { return layer == 0 ? inputs_ : layers_[layer - 1].values; }
  bool IsOutput(size_t layer) const { return layer + 1 == layers_.size(); }
  auto At(Columns& of, int step) const {
    return of.middleCols(first_[step], first_[step + 1] - first_[step]);
  }
  Eigen::VectorXd BiasOf(const Layer& layer) const;
  // Room for all columns of the steps so far.
  void Grow();

  const VectorKernels& kernels_;
  const bool rectified_, from_rest_;
  const double* weights_ = nullptr;
  std::vector<Layer> layers_;
  std::vector<int> first_ = {0};  // column of each step, and the total
  PackedMatrix right_;
  Columns inputs_;  // of all steps
};

}  // namespace pushid
