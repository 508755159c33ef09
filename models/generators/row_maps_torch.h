// models: sparse linear maps between rows of tensors, for what a network over time does beside
// products of matrices. Included by *_torch.cc files alone.
//
// Rows are frames: those of the first person, then those of the next, as many as each has. Nothing
// is padded, and products are over all rows at once. LibTorch's convolutions take twice as long:
// their kernels are compiled anew for every number of people and of frames.
#pragma once

#include <Eigen/SparseCore>

#include "models/restoration/support_torch.h"

namespace pushid {

// A row of `sums` for every row that comes out: what it sums, with which weights. Filled row by
// row.
struct RowMap : torch::CustomClassHolder {
  Eigen::SparseMatrix<float, Eigen::RowMajor> sums;

  RowMap(int64_t out, int64_t in) : sums(out, in) {}
  void BeginRow() { sums.startVec(++row_); }
  void Add(int64_t in, float weight = 1.0f) { sums.insertBack(row_, in) = weight; }

 private:
  int64_t row_ = -1;
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
    const torch::Tensor to = torch::empty({map->sums.rows(), x.size(1)});
    const torch::Tensor from = x.contiguous();
    AsMatrix(to).noalias() = map->sums * AsMatrix(from);
    return to;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const auto map =
        c10::static_intrusive_pointer_cast<RowMap>(context->saved_data["map"].toCapsule());
    const torch::Tensor from = gradients[0].contiguous();
    const torch::Tensor to = torch::empty({map->sums.cols(), from.size(1)});
    AsMatrix(to).noalias() = map->sums.transpose() * AsMatrix(from);
    return {to, torch::Tensor()};
  }
};

inline torch::Tensor Mapped(const torch::Tensor& x, const RowMapPointer& map) {
  return MappedRows::apply(x, map);
}

}  // namespace pushid
