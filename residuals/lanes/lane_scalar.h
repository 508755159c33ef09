// residuals: vectors of doubles as the processor has them, with the functions of the standard
// library, and a number for each of several people side by side, a scalar of the models' templates;
// for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector
// and is compiled for such vectors: nothing here may be shared between files, hence no external
// linkage, and types without it, so that what is made of them stays in that file too.
#pragma once

#include <Eigen/Core>

namespace pushid {
namespace {

using Vector = double __attribute__((vector_size(8 * PUSHID_VECTOR_DOUBLES)));
using Bits = long long __attribute__((vector_size(sizeof(Vector))));  // of a number, or yes and no

inline Vector Load(const double* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof(vector));
  return vector;
}

// exp(x) - 1 = 2^n (1 + p) - 1 with p = exp(r) - 1 by its series, x = n ln 2 + r, |r| <= ln 2 / 2:
// p starts with r, so that the result is exact to rounding near zero too. Vectors throughout, since
// compilers leave the plain loop alone where bounds are to respect NaN.
struct Exponential {
  Vector power, p;  // 2^n, p
};

inline Exponential Expand(Vector x) {
  constexpr double kLog2e = 1.4426950408889634074, kRound = 6755399441055744.0;  // 1.5 * 2^52
  constexpr double kLn2High = 6.93145751953125e-1, kLn2Low = 1.42860682030941723212e-6;
  constexpr double kFactorials[] = {479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0,
                                    720.0,       120.0,      24.0,      6.0,      2.0};
  const Vector shifted = x * kLog2e + kRound;
  const Vector n = shifted - kRound;
  const Vector r = (x - n * kLn2High) - n * kLn2Low;
  Vector series = Vector{} + 1.0 / 6227020800.0;  // 1 / 13!
#pragma GCC unroll 16
  for (double factorial : kFactorials) series = series * r + 1.0 / factorial;
  const Bits power = ((Bits)shifted + 1023) << 52;  // the shifted number ends in n
  return {(Vector)power, r + r * r * series};
}

inline Vector Clamp(Vector x, double bound) {
  const Vector below = x > bound ? Vector{} + bound : x;  // in this order NaN stays NaN
  return below < -bound ? Vector{} - bound : below;
}

// To about two units in the last place, near zero too.
inline Vector TanhOf(Vector x) {
  const Exponential e = Expand(2.0 * Clamp(x, 20.0));  // +-1 beyond
  const Vector expm1 = e.power * e.p + (e.power - 1.0);
  return expm1 / (expm1 + 2.0);
}

// To about an ulp.
inline Vector ExpOf(Vector x) {
  const Exponential e = Expand(Clamp(x, 700.0));
  return e.power + e.power * e.p;
}

struct SineAndCosine {
  Vector sine, cosine;
};

// To about an ulp up to some 1e5 rad: x = n pi / 2 + r, |r| <= pi / 4, and their series of r.
inline SineAndCosine SinCosOf(Vector x) {
  constexpr double kTwoOverPi = 6.36619772367581382433e-01, kRound = 6755399441055744.0;
  // pi / 2 in three parts, so that n times each of the first two is exact.
  constexpr double kHigh = 1.57079632673412561417, kMiddle = 6.07710050630396597660e-11,
                   kLow = 2.02226624879595063154e-21;
  const Vector shifted = x * kTwoOverPi + kRound;
  const Vector n = shifted - kRound;
  const Vector r = ((x - n * kHigh) - n * kMiddle) - n * kLow, square = r * r;
  constexpr double kOfSine[] = {1307674368000.0, 6227020800.0, 39916800.0, 362880.0,
                                5040.0,          120.0,        6.0};  // 15! ... 3!
  constexpr double kOfCosine[] = {20922789888000.0, 87178291200.0, 479001600.0, 3628800.0,
                                  40320.0,          720.0,         24.0};  // 16! ... 4!
  Vector s = Vector{} - 1.0 / kOfSine[0], c = Vector{} + 1.0 / kOfCosine[0];
#pragma GCC unroll 8
  for (int i = 1; i < 7; ++i) {
    const double sign = i % 2 == 0 ? -1.0 : 1.0;
    s = s * square + sign / kOfSine[i];
    c = c * square - sign / kOfCosine[i];
  }
  const Vector sine = r + r * square * s;
  const Vector cosine = 1.0 - (0.5 * square - square * square * c);
  const Bits quarter = (Bits)shifted;  // ends in n
  const Bits odd = (quarter & 1) != 0, second = (quarter & 2) != 0,
             other = ((quarter + 1) & 2) != 0;
  const Vector of_sine = odd ? cosine : sine, of_cosine = odd ? sine : cosine;
  return {second ? -of_sine : of_sine, other ? -of_cosine : of_cosine};
}

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
