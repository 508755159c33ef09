// residuals: learned terms of many people at once, step by step, and back: d(cost)/d(weights) of
// whole rollouts by the adjoint. Everybody is a column, and all steps of all people stand side by
// side for one product.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/learned_terms.h"
#include "models/self_network.h"

namespace pushid {

// People side by side, one column each, over as many steps as each of them has.
//
// People who go on longest are the first columns, so that a step has the first `active` of them.
// All that is kept of a step stands side by side in one matrix of total() columns.
class BatchColumns {
 public:
  // steps: by person; never increasing.
  explicit BatchColumns(const std::vector<int>& steps) {
    const int longest = steps.empty() ? 0 : steps.front();
    int active = static_cast<int>(steps.size());
    for (int step = 0; step < longest; ++step) {
      while (steps[active - 1] <= step) --active;
      first_.push_back(first_.back() + active);
    }
  }

  int num_steps() const { return static_cast<int>(first_.size()) - 1; }
  int active(int step) const { return first_[step + 1] - first_[step]; }
  int total() const { return first_.back(); }
  // The columns of a step.
  auto At(Eigen::MatrixXd& of, int step) const { return of.middleCols(first_[step], active(step)); }

 private:
  std::vector<int> first_ = {0};  // column of each step, and the total
};

// A self-force network (models/self_network.h). With Z = [x; h] and W the rows of all gates,
//   S = W Z + C k,  activations a(S), memories and outputs by element,
// and backwards, with D = d(cost)/dS from the adjoints of outputs and memories,
//   Z^ = W' D,   W^ = sum over steps D Z' = one product over all (people x steps).
// Z, activations and cells of every step are kept.
// An ldp network, whose gates are all biased, has for k 1 and 1, and its mass goes to the
// embedding.
class BatchedNetwork {
 public:
  using Columns = Eigen::MatrixXd;

  // masses: by column.
  BatchedNetwork(const NetworkShape& shape, const BatchColumns& columns,
                 const std::vector<double>& masses);

  // Everybody's memory back to zero. weights: there until the last step back.
  void Start(const double* weights);

  // inputs: u, one column for each who is active. forces: 4 x active.
  void Forward(int step, const Columns& inputs, Columns* forces);

  // A person leaves after a step: nothing of it is kept, and there is no memory after it.
  void Forget(int step, int column);

  // From the last step to the first: the adjoints of a step's forces to those of its inputs.
  void Backward(int step, const Columns& forces, Columns* inputs);

  // After the last of these: adds d(cost)/d(weights).
  void AddWeightGradient(double* gradient);

 private:
  auto At(Columns& of, int step) const { return columns_.At(of, step); }
  // Rows of the hidden units' k-th activation.
  auto Part(Columns& of, int step, int k) const {
    return At(of, step).middleRows(k * shape_.hidden, shape_.hidden).array();
  }
  NetworkWeights<double> Weights() const { return {shape_, weights_}; }
  // From the sums of a step, in activations_, to the hidden units; and from d(cost)/dh to D in
  // activations_ and to the carried adjoint's direct part.
  void ActivateMlp(int step);
  void DeactivateMlp(int step, const Columns& hidden);
  void ActivateLdp(int step);
  void DeactivateLdp(int step, const Columns& hidden);

  NetworkShape shape_;
  BatchColumns columns_;
  const double* weights_ = nullptr;  // of the last Start
  Eigen::VectorXd scale_;            // newtons per output, by column
  Columns own_, context_;            // k, and what the gates see of it, by column
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> stacked_;  // W

  Columns inputs_, z_, activations_, hidden_, cells_, cell_tanh_;  // of all steps
  Columns context_sum_, by_context_sum_;                           // C k, and its adjoint
  Columns rest_;                                                   // mlp: tanh(C k)
  Columns outputs_, embedded_;                                     // adjoints of O h, of E u
  Columns hidden_carry_, cell_carry_;                              // adjoints from the next step
};

// Dense layers, of a learned rod or interaction (models/learned_terms.h).
//
// Everybody, or each of two people who touch, is a column of U. Forwards, with H_0 = U,
//   H_i = tanh(W_i H_(i-1) + b_i);  Y = O H_last + c
// and backwards, with D = H^ tanh' from the adjoint H^ of a layer's values (D = Y^ of the last),
//   H^_below = W' D,   W^ = sum over steps D H_below' = one product over all columns,   b^ = sum D.
// H and D of every step are kept: 16 bytes a unit and column. Of LDP's networks max(0, .) stands
// for tanh.
class BatchedLayers {
 public:
  using Columns = Eigen::MatrixXd;

  // As RunLayers has them (models/learned_terms.h).
  BatchedLayers(int inputs, const std::vector<int>& hidden, int outputs, bool rectified);

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
  struct Layer {
    int rows, width, at;   // of W; its first weight
    Eigen::VectorXd bias;  // b^
    Columns values, back;  // of all steps: H (Y of the last), D
  };

  // Inputs of a layer at all steps.
  Columns& Below(size_t layer) { return layer == 0 ? inputs_ : layers_[layer - 1].values; }
  bool IsOutput(size_t layer) const { return layer + 1 == layers_.size(); }
  auto At(Columns& of, int step) const {
    return of.middleCols(first_[step], first_[step + 1] - first_[step]);
  }
  // [W b].
  ConstRows<double> WeightsOf(const Layer& layer) const {
    return LayerAt(weights_ + layer.at, layer.rows, layer.width);
  }
  // Room for all columns of the steps so far.
  void Grow();

  const bool rectified_;
  const double* weights_ = nullptr;
  std::vector<Layer> layers_;
  std::vector<int> first_ = {0};  // column of each step, and the total
  Columns inputs_;                // of all steps
};

}  // namespace pushid
