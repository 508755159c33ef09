// models: products of single-precision matrices, which is what networks do nearly all of the time.
//
// Releases are built for any x86-64, where Eigen's own products have 128-bit vectors and no fused
// multiply-add; this loop is compiled for the wider ones too, and the processor chooses. Another
// width rounds otherwise: results repeat bit by bit on one machine, and to rounding across.
// residuals/packed/vector_kernels.h has the like for doubles, and what was rejected.
#pragma once

#include <Eigen/Core>

namespace pushid {

// a b
Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b);

}  // namespace pushid
