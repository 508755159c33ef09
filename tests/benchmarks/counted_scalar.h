// benchmarks: one lane that counts what is done to it, in place of
// residuals/lanes/lane_scalar.h.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace pushid {
namespace {

struct OperationCounts {
  long long sums_and_products = 0, quotients_and_roots = 0, transcendental = 0;
};
OperationCounts counted;

using Bits = long long;  // all ones or none

struct Lanes {
  double v;

  Lanes() = default;
  Lanes(double value) : v(value) {}  // NOLINT: a constant

  Lanes operator-() const { return -v; }
  Lanes& operator+=(Lanes y) { return *this = *this + y; }
  Lanes& operator-=(Lanes y) { return *this = *this - y; }
  Lanes& operator*=(Lanes y) { return *this = *this * y; }
  Lanes& operator/=(Lanes y) { return *this = *this / y; }
  friend Lanes operator+(Lanes x, Lanes y) { return ++counted.sums_and_products, x.v + y.v; }
  friend Lanes operator-(Lanes x, Lanes y) { return ++counted.sums_and_products, x.v - y.v; }
  friend Lanes operator*(Lanes x, Lanes y) { return ++counted.sums_and_products, x.v * y.v; }
  friend Lanes operator/(Lanes x, Lanes y) { return ++counted.quotients_and_roots, x.v / y.v; }
  friend Bits operator>(Lanes x, Lanes y) { return x.v > y.v ? -1 : 0; }
  friend Bits operator!=(Lanes x, Lanes y) { return x.v != y.v ? -1 : 0; }
};

inline Lanes Select(Bits which, Lanes yes, Lanes no) { return which != 0 ? yes : no; }
inline Lanes LoadLanes(const double* from) { return *from; }
inline void Store(Lanes x, double* to) { *to = x.v; }

inline Lanes abs(Lanes x) { return std::abs(x.v); }
inline Lanes sqrt(Lanes x) { return ++counted.quotients_and_roots, std::sqrt(x.v); }
inline Lanes exp(Lanes x) { return ++counted.transcendental, std::exp(x.v); }
inline Lanes sin(Lanes x) { return ++counted.transcendental, std::sin(x.v); }
inline Lanes cos(Lanes x) { return ++counted.transcendental, std::cos(x.v); }

}  // namespace
}  // namespace pushid

template <>
struct Eigen::NumTraits<pushid::Lanes> : Eigen::NumTraits<double> {
  using Real = pushid::Lanes;
  using NonInteger = pushid::Lanes;
  using Nested = pushid::Lanes;
  using Literal = double;
};
