// residuals: a few rows times many columns, which is how derivatives go from step to step: c = a b
// or c += a b with a small and b, c by rows, so that vectors run along the columns.
#pragma once

#include <Eigen/Core>

#include "residuals/kernels/vector_kernels.h"

namespace pushid {

template <typename A, typename B, typename C>
void NarrowProduct(const A& a, const B& b, bool add, C&& c) {
  static_assert(B::IsRowMajor && std::decay_t<C>::IsRowMajor, "vectors run along the columns");
  const Eigen::Matrix<double, A::RowsAtCompileTime, A::ColsAtCompileTime, Eigen::RowMajor> rows = a;
  BestVectorKernels().narrow_product(static_cast<int>(a.rows()), static_cast<int>(a.cols()),
                                     b.cols(), rows.data(), b.data(), b.outerStride(), c.data(),
                                     c.outerStride(), add);
}

template <typename A, typename B, typename C>
void SetNarrowProduct(const A& a, const B& b, C&& c) {
  NarrowProduct(a, b, false, c);
}

template <typename A, typename B, typename C>
void AddNarrowProduct(const A& a, const B& b, C&& c) {
  NarrowProduct(a, b, true, c);
}

}  // namespace pushid
