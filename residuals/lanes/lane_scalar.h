// residuals: a number for each of several people side by side, a scalar of the models' templates.
// For the file that includes this, as vector_math.h says: a type without linkage, so that what is
// made of it stays in that file too.
#pragma once

#include <Eigen/Core>

#include "residuals/packed/vector_math.h"

namespace pushid {
namespace {

struct Lanes {
  Vector v;

  Lanes() = default;
  Lanes(double same) : v(Vector{} + same) {}  // NOLINT: a constant
  explicit Lanes(Vector vector) : v(vector) {}

  Lanes operator-() const { return Lanes(-v); }
  Lanes& operator+=(Lanes y) { return *this = Lanes(v + y.v); }
  Lanes& operator-=(Lanes y) { return *this = Lanes(v - y.v); }
  Lanes& operator*=(Lanes y) { return *this = Lanes(v * y.v); }
  Lanes& operator/=(Lanes y) { return *this = Lanes(v / y.v); }
  friend Lanes operator+(Lanes x, Lanes y) { return Lanes(x.v + y.v); }
  friend Lanes operator-(Lanes x, Lanes y) { return Lanes(x.v - y.v); }
  friend Lanes operator*(Lanes x, Lanes y) { return Lanes(x.v * y.v); }
  friend Lanes operator/(Lanes x, Lanes y) { return Lanes(x.v / y.v); }
  friend Bits operator>(Lanes x, Lanes y) { return x.v > y.v; }
  friend Bits operator!=(Lanes x, Lanes y) { return x.v != y.v; }
};

inline Lanes Select(Bits which, Lanes yes, Lanes no) { return Lanes(which ? yes.v : no.v); }

inline Lanes LoadLanes(const double* from) { return Lanes(Load(from)); }
inline void Store(Lanes x, double* to) { __builtin_memcpy(to, &x.v, sizeof(x.v)); }

inline Lanes abs(Lanes x) { return Select(0.0 > x, -x, x); }
inline Lanes sqrt(Lanes x) {
  Lanes root;
  for (int i = 0; i < PUSHID_VECTOR_DOUBLES; ++i) root.v[i] = __builtin_sqrt(x.v[i]);
  return root;
}
inline Lanes exp(Lanes x) { return Lanes(ExpOf(x.v)); }
inline Lanes tanh(Lanes x) { return Lanes(TanhOf(x.v)); }
inline Lanes sin(Lanes x) { return Lanes(SinCosOf(x.v).sine); }
inline Lanes cos(Lanes x) { return Lanes(SinCosOf(x.v).cosine); }

}  // namespace
}  // namespace pushid

template <>
struct Eigen::NumTraits<pushid::Lanes> : Eigen::NumTraits<double> {
  using Real = pushid::Lanes;
  using NonInteger = pushid::Lanes;
  using Nested = pushid::Lanes;
  using Literal = double;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
