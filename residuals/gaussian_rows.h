// residuals: the negative log likelihood of a Gaussian as squares, exactly.
//   -log N(v; 0, L L') = |L^-1 v|^2 / 2 + sum_i log L_ii + const
//   rows: L^-1 v, and sqrt(2 (log L_ii + c_i)), half of whose squares is log L_ii + c_i.
// Any shift c gives the same optimum. With c_i = 1/2 - log L_ii at the point where a problem is
// built, J'J there is the Fisher information, in expectation, so that Gauss-Newton is Fisher
// scoring and a covariance from J'J is right; but log L_ii may fall by 1/2 only before the rows
// end. Far from the optimum a larger shift lets it fall further, at a curvature that is too low; a
// solve goes on from a problem built anew. Eq. 5 of Lyu et al., ACM MM 2021, is this density.
#pragma once

#include <cmath>

#include "models/pendulum_filter.h"

namespace pushid {

inline constexpr double kFisherShift = 0.5;

// shift: c_i. rows: 2 N of them. False where log L_ii + c_i is no longer positive.
template <typename T, int N>
bool GaussianRows(const Eigen::Matrix<T, N, 1>& v, const Eigen::Matrix<T, N, N>& lower,
                  const double* shift, T* rows) {
  using std::log, std::sqrt;
  Eigen::Map<Eigen::Matrix<T, N, 1>> white(rows);
  white = SolveLower<T, N, 1>(lower, v);
  for (int i = 0; i < N; ++i) {
    const T log_scale = log(lower(i, i)) + shift[i];
    if (!(RealPart(log_scale) > 0.0)) return false;
    rows[N + i] = sqrt(2.0 * log_scale);
  }
  return true;
}

// Half the squared rows less this is -log N(v; 0, L L') of one v.
template <int N>
double GaussianOffset(const double* shift) {
  constexpr double kLogTwoPi = 1.8378770664093453;
  double offset = -0.5 * N * kLogTwoPi;
  for (int i = 0; i < N; ++i) offset += shift[i];
  return offset;
}

}  // namespace pushid
