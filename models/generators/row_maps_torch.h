// models: sparse linear maps between rows of tensors, for what a network over time does beside
// products of matrices. Included by *_torch.cc files alone.
//
// Rows are frames: those of the first person, then those of the next, as many as each has. Nothing
// is padded, and products are over all rows at once, which is half of the time of convolutions by
// LibTorch: those compile their kernels anew for every number of people and of frames.
#pragma once

#include <utility>
#include <vector>

#include "models/restoration/support_torch.h"

namespace pushid {

// Row i of the result: the sum of weights times rows of what comes in.
struct RowMap : torch::CustomClassHolder {
  int64_t inputs = 0;                // rows that come in
  std::vector<int64_t> begin = {0};  // of each row's entries, and their end
  std::vector<int64_t> rows;
  std::vector<float> weights;

  explicit RowMap(int64_t all_inputs) : inputs(all_inputs) {}
  int64_t outputs() const { return static_cast<int64_t>(begin.size()) - 1; }
  void Add(int64_t row, float weight = 1.0f) { rows.push_back(row), weights.push_back(weight); }
  void EndRow() { begin.push_back(static_cast<int64_t>(rows.size())); }
};
using RowMapPointer = c10::intrusive_ptr<RowMap>;

using RowMajorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
inline Eigen::Map<RowMajorMatrix> AsMatrix(const torch::Tensor& rows) {
  return {rows.data_ptr<float>(), rows.size(0), rows.size(1)};
}

// [row, channel] to [row, channel].
class MappedRows : public torch::autograd::Function<MappedRows> {
 public:
  static torch::Tensor forward(torch::autograd::AutogradContext* context, const torch::Tensor& x,
                               const RowMapPointer& map) {
    context->saved_data["map"] = c10::IValue::make_capsule(map);
    const torch::Tensor from = x.contiguous();
    torch::Tensor to = torch::zeros({map->outputs(), from.size(1)});
    auto in = AsMatrix(from), out = AsMatrix(to);
    for (int64_t i = 0; i < map->outputs(); ++i) {
      for (int64_t k = map->begin[i]; k < map->begin[i + 1]; ++k) {
        out.row(i) += map->weights[k] * in.row(map->rows[k]);
      }
    }
    return to;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const auto map =
        c10::static_intrusive_pointer_cast<RowMap>(context->saved_data["map"].toCapsule());
    const torch::Tensor from = gradients[0].contiguous();
    torch::Tensor to = torch::zeros({map->inputs, from.size(1)});
    auto in = AsMatrix(from), out = AsMatrix(to);
    for (int64_t i = 0; i < map->outputs(); ++i) {
      for (int64_t k = map->begin[i]; k < map->begin[i + 1]; ++k) {
        out.row(map->rows[k]) += map->weights[k] * in.row(i);
      }
    }
    return {to, torch::Tensor()};
  }
};

inline torch::Tensor Mapped(const torch::Tensor& x, const RowMapPointer& map) {
  return MappedRows::apply(x, map);
}

}  // namespace pushid
