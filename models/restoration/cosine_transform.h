// models: the cosine transform over time, by which the peers read and write motions.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace pushid {

// Orthonormal DCT-II of `frames` values: row k of the matrix gives coefficient k, and the matrix
// transposed gives the values back.
inline Eigen::MatrixXd CosineTransform(int frames) {
  Eigen::MatrixXd transform(frames, frames);
  for (int k = 0; k < frames; ++k) {
    for (int t = 0; t < frames; ++t) {
      transform(k, t) =
          std::sqrt((k == 0 ? 1.0 : 2.0) / frames) * std::cos(M_PI * (t + 0.5) * k / frames);
    }
  }
  return transform;
}

}  // namespace pushid
