// residuals: the one jet of the derivatives: a number with its derivatives by eight columns, in the
// vectors of the processor, a scalar of the models' templates. A file that is compiled for wider
// vectors says, before it includes this,
//   PUSHID_VECTOR_DOUBLES      doubles in a vector; else 2, which every processor has
// A type without linkage, so that what is made of it stays in that file too
// (tests/residuals/shared_code.sh).
//
// It allocates nothing, and every operation is the same sum of products, whatever the width of the
// vectors: without contraction (-ffp-contract=off) the bits are equal on all processors.
#pragma once

#include <Eigen/Core>

#ifndef PUSHID_VECTOR_DOUBLES
#define PUSHID_VECTOR_DOUBLES 2
#endif

namespace pushid {
namespace {

struct VectorJet {
  static constexpr int kColumns = 8;
  static constexpr int kVectors = kColumns / PUSHID_VECTOR_DOUBLES;
  // Aligned as doubles are: containers know of no wider alignment.
  using Part = double __attribute__((vector_size(8 * PUSHID_VECTOR_DOUBLES), aligned(8)));

  double a;          // the value
  Part v[kVectors];  // its derivatives

  VectorJet() = default;
  VectorJet(double constant) : a(constant) {  // NOLINT: has no derivatives
    for (Part& part : v) part = Part{};
  }
  // The names are those of models/dual.h.
  static VectorJet Constant(double value) { return {value}; }
  static VectorJet Input(double value, int column) {
    VectorJet input(value);
    input.AddSlope(column, 1.0);
    return input;
  }
  double Slope(int column) const {
    return v[column / PUSHID_VECTOR_DOUBLES][column % PUSHID_VECTOR_DOUBLES];
  }
  void AddSlope(int column, double slope) {
    v[column / PUSHID_VECTOR_DOUBLES][column % PUSHID_VECTOR_DOUBLES] += slope;
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
  friend VectorJet operator+(double c, VectorJet x) { return x.a = c + x.a, x; }
  friend VectorJet operator-(VectorJet x, double c) { return x.a -= c, x; }
  friend VectorJet operator-(double c, const VectorJet& x) { return Scaled(c - x.a, -1.0, x); }
  friend VectorJet operator*(const VectorJet& x, double c) { return Scaled(x.a * c, c, x); }
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
  friend VectorJet log(const VectorJet& x) { return Scaled(__builtin_log(x.a), 1.0 / x.a, x); }
  friend VectorJet tanh(const VectorJet& x) {
    const double value = __builtin_tanh(x.a);
    return Scaled(value, 1.0 - value * value, x);
  }
  friend VectorJet sin(const VectorJet& x) {
    return Scaled(__builtin_sin(x.a), __builtin_cos(x.a), x);
  }
  friend VectorJet cos(const VectorJet& x) {
    return Scaled(__builtin_cos(x.a), -__builtin_sin(x.a), x);
  }
};

}  // namespace
}  // namespace pushid

template <>
struct Eigen::NumTraits<pushid::VectorJet> : Eigen::NumTraits<double> {
  using Real = pushid::VectorJet;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, pushid::VectorJet, Operation> {
  using ReturnType = pushid::VectorJet;
};
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<pushid::VectorJet, double, Operation> {
  using ReturnType = pushid::VectorJet;
};
