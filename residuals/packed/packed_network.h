// residuals: a self-force network (models/self_network.h) of many people at once, step by step, and
// back: d(cost)/d(weights) of whole rollouts by the adjoint.
//
// Everybody is a column. With Z = [x; h; k] and the rows of all gates and candidates stacked to W,
//   S = W Z,  activations a(S), memories and outputs by element,
// and backwards, with D = d(cost)/dS from the adjoints of outputs and memories,
//   Z^ = W' D,   W^ = sum over steps D Z' = one product over all (people x steps).
// Z, activations and cells of every step are kept.
// Of an ldp network, whose gates are all biased, k is 1 and 1, and its mass goes to the embedding.
// A GRU multiplies U_n h by r: there W has the rows [W_n 0] and [0 U_n] in place of [W_n U_n], a
// third more work, for one product instead of three.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/self_network.h"
#include "residuals/packed/packed_matrix.h"

namespace pushid {

// People side by side, one column each, over as many steps as each of them has.
//
// Those who go on longest are the first columns, so that a step has the first `active` of them.
// What is kept of every step stands side by side in one matrix of total() columns.
class PackedColumns {
 public:
  // steps: by person; never increasing.
  explicit PackedColumns(const std::vector<int>& steps) {
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

// The candidates' rows [W U] in the stacked matrix, below those of the gates: of a network with
// cells in one piece, of the others W above U, because a gate scales what U makes of h.
// visit(row, first column, columns)
template <typename Visit>
void ForCandidates(const NetworkShape& s, Visit visit) {
  if (s.candidate_rows() == 0) return;
  if (s.cells() > 0) {
    visit(s.gate_rows(), 0, s.candidate_width());
  } else {
    visit(s.gate_rows(), 0, s.num_features());
    visit(s.gate_rows() + s.hidden, s.num_features(), s.hidden);
  }
}

class PackedNetwork {
 public:
  using Columns = Eigen::MatrixXd;

  // masses: by column.
  PackedNetwork(const NetworkShape& shape, const VectorKernels& kernels,
                const PackedColumns& columns, const std::vector<double>& masses);

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
  NetworkWeights<double> Weights() const { return {shape_, weights_}; }
  void PackWeights();
  // From a person's sums of a step, in activations_, to the hidden units; and from d(cost)/dh to D
  // in activations_ and to the carried adjoint's direct part.
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  void Activate##Kind(int step, int column);                           \
  void Deactivate##Kind(int step, int column, const Columns& hidden);
  PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
  void Activate(int step);
  void Deactivate(int step, const Columns& hidden);

  NetworkShape shape_;
  PackedColumns columns_;
  const VectorKernels& kernels_;
  const double* weights_ = nullptr;  // of the last Start
  int rows_;                         // of W
  Eigen::VectorXd scale_;            // newtons per output, by column
  Columns own_, context_;            // k, and what the gates see of it, by column
  PackedMatrix stacked_, transposed_, right_;

  Columns inputs_, z_, activations_, hidden_, cells_, cell_tanh_;  // of all steps
  Columns rest_, context_sum_;                                     // mlp: tanh(C k), adjoint of C k
  Columns outputs_, embedded_;                                     // adjoints of O h, of E u
  Columns hidden_carry_, cell_carry_;                              // adjoints from the next step
};

}  // namespace pushid
