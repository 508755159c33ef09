// residuals: a number with its derivatives by some columns of a fit in the vectors of a processor,
// a scalar of the models' templates. For the file that includes this, as vector_math.h says: a type
// without linkage, so that what is made of it stays in that file too.
#pragma once

#include <Eigen/Core>

#include "residuals/packed/vector_math.h"

namespace pushid {
namespace {

template <int kColumns>
struct VectorJet {
  static constexpr int kWidth = PUSHID_VECTOR_DOUBLES;
  static constexpr int kVectors = kColumns / kWidth;
  static_assert(kColumns % kWidth == 0);
  double a;            // the value
  Vector v[kVectors];  // its derivatives

  VectorJet() = default;
  VectorJet(double constant) : a(constant) {  // NOLINT: has no derivatives
    for (Vector& part : v) part = Vector{};
  }
  VectorJet(double value, const double* slopes) : a(value) {
    for (int i = 0; i < kVectors; ++i) v[i] = Load(slopes + i * kWidth);
  }
  void StoreSlopes(double* to) const { __builtin_memcpy(to, v, sizeof(v)); }

  VectorJet& operator+=(const VectorJet& y) { return *this = *this + y; }
  VectorJet& operator-=(const VectorJet& y) { return *this = *this - y; }
  VectorJet& operator*=(const VectorJet& y) { return *this = *this * y; }
  VectorJet& operator/=(const VectorJet& y) { return *this = *this / y; }

  // value, with the derivatives of c x + d y.
  static VectorJet Sum(double value, double c, const VectorJet& x, double d, const VectorJet& y) {
    VectorJet sum;
    sum.a = value;
    for (int i = 0; i < kVectors; ++i) sum.v[i] = c * x.v[i] + d * y.v[i];
    return sum;
  }
  // value, with the derivatives of c x.
  static VectorJet Scaled(double value, double c, const VectorJet& x) {
    VectorJet scaled;
    scaled.a = value;
    for (int i = 0; i < kVectors; ++i) scaled.v[i] = c * x.v[i];
    return scaled;
  }

  VectorJet operator-() const { return Scaled(-a, -1.0, *this); }
  friend VectorJet operator+(const VectorJet& x, const VectorJet& y) {
    VectorJet sum;
    sum.a = x.a + y.a;
    for (int i = 0; i < kVectors; ++i) sum.v[i] = x.v[i] + y.v[i];
    return sum;
  }
  friend VectorJet operator-(const VectorJet& x, const VectorJet& y) {
    VectorJet difference;
    difference.a = x.a - y.a;
    for (int i = 0; i < kVectors; ++i) difference.v[i] = x.v[i] - y.v[i];
    return difference;
  }
  friend VectorJet operator*(const VectorJet& x, const VectorJet& y) {
    return Sum(x.a * y.a, y.a, x, x.a, y);
  }
  friend VectorJet operator/(const VectorJet& x, const VectorJet& y) {
    const double inverse = 1.0 / y.a, value = x.a / y.a;
    return Sum(value, inverse, x, -value * inverse, y);
  }
  // With a constant, which has no derivatives to carry.
  friend VectorJet operator+(VectorJet x, double c) { return x.a += c, x; }
  friend VectorJet operator+(double c, VectorJet x) { return x.a += c, x; }
  friend VectorJet operator-(VectorJet x, double c) { return x.a -= c, x; }
  friend VectorJet operator-(double c, const VectorJet& x) { return Scaled(c - x.a, -1.0, x); }
  friend VectorJet operator*(const VectorJet& x, double c) { return Scaled(c * x.a, c, x); }
  friend VectorJet operator*(double c, const VectorJet& x) { return Scaled(c * x.a, c, x); }
  friend VectorJet operator/(const VectorJet& x, double c) { return Scaled(x.a / c, 1.0 / c, x); }
  friend VectorJet operator/(double c, const VectorJet& x) {
    return Scaled(c / x.a, -c / (x.a * x.a), x);
  }

  friend VectorJet sqrt(const VectorJet& x) {
    const double root = __builtin_sqrt(x.a);
    return Scaled(root, 0.5 / root, x);
  }
  friend VectorJet exp(const VectorJet& x) {
    const double value = __builtin_exp(x.a);
    return Scaled(value, value, x);
  }
};

}  // namespace
}  // namespace pushid

template <int kColumns>
struct Eigen::NumTraits<pushid::VectorJet<kColumns>> : Eigen::NumTraits<double> {
  using Real = pushid::VectorJet<kColumns>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
template <int kColumns, typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, pushid::VectorJet<kColumns>, Operation> {
  using ReturnType = pushid::VectorJet<kColumns>;
};
template <int kColumns, typename Operation>
struct Eigen::ScalarBinaryOpTraits<pushid::VectorJet<kColumns>, double, Operation> {
  using ReturnType = pushid::VectorJet<kColumns>;
};
