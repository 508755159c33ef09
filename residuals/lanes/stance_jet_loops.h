// residuals: the jets of person_lanes.h for the file that includes this, as person_lanes_loops.h.
#pragma once

#include <Eigen/Core>

#include "models/stance.h"
#include "residuals/lanes/person_lanes.h"
#include "residuals/packed/vector_math.h"

namespace pushid {
namespace {

// A number with its derivatives by some columns of a fit in the vectors of a processor, a scalar of
// the models' templates: a type without linkage, so that what is made of it stays in the file that
// includes this, as vector_math.h says.
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

namespace pushid {
namespace {

constexpr int kMostColumns = 16, kLeastColumns = 8;  // that a jet has

// x m / (x^4 + m^4)^(1/4), whose factors as jets take five times as long.
template <int kColumns>
VectorJet<kColumns> Limited(const VectorJet<kColumns>& x, const VectorJet<kColumns>& most) {
  const double x2 = x.a * x.a, most2 = most.a * most.a, x4 = x2 * x2, most4 = most2 * most2;
  const double sum = x4 + most4, inverse = 1.0 / __builtin_sqrt(__builtin_sqrt(sum));
  const double slope = inverse / sum;
  return VectorJet<kColumns>::Sum(x.a * most.a * inverse, most.a * most4 * slope, x,
                                  x.a * x4 * slope, most);
}

}  // namespace

template <>
inline VectorJet<kMostColumns> SmoothLimit(const VectorJet<kMostColumns>& x,
                                           const VectorJet<kMostColumns>& most) {
  return Limited(x, most);
}
template <>
inline VectorJet<kLeastColumns> SmoothLimit(const VectorJet<kLeastColumns>& x,
                                            const VectorJet<kLeastColumns>& most) {
  return Limited(x, most);
}

namespace {

// Of the columns from `first` on.
template <int kColumns>
void StanceJetOf(const StanceJetInputs& in, std::ptrdiff_t first, double* of_forces,
                 double* of_feet) {
  using T = VectorJet<kColumns>;
  const auto input = [&](double value, const double* rows, int row) {
    return T(value, rows + row * in.columns + first);
  };
  FeetState<T> feet;
  for (int i = 0; i < 2; ++i) feet.apart[i] = input(in.feet[i], in.by_feet, i);
  feet.clock = input(in.feet[2], in.by_feet, 2);
  feet.swing_time = input(in.feet[3], in.by_feet, 3);
  feet.swings = in.swings;
  feet.landed = in.landed;
  feet.fresh = in.fresh;
  const auto hip = [&](const PerceivedHip& felt, const double* rows) {
    const T theta = input(0.0, rows, 0), phi = input(0.0, rows, 1);
    Angles<T> angles;
    angles.s_th = T::Scaled(felt.s_th, felt.c_th, theta);
    angles.c_th = T::Scaled(felt.c_th, -felt.s_th, theta);
    angles.s_ph = T::Scaled(felt.s_ph, felt.c_ph, phi);
    angles.c_ph = T::Scaled(felt.c_ph, -felt.s_ph, phi);
    Vector4<T> qd;
    for (int i = 0; i < 4; ++i) qd[i] = input(felt.qd[i], rows, 2 + i);
    return HipOverFeet<T>(in.body, angles, qd);
  };
  const HipOverFeet<T> ankle = hip(in.ankle, in.by_ankle);
  const HipOverFeet<T> step = in.by_step != nullptr ? hip(in.step, in.by_step) : ankle;
  int next = 0;  // in the order of the members, which is that of kIds
  const StanceParameters<T> p([&](Parameter) {
    const int row = next++;
    return input(in.parameters[row], in.by_parameter, row);
  });
  const StanceForces<T> out = StanceStep<T>(in.body, p, feet, ankle, step.Capture(in.body)).Run();
  const T* const forces[] = {&out.velocity[0], &out.velocity[1], &out.torque[0], &out.torque[1]};
  const T* const after[] = {&out.next.apart[0], &out.next.apart[1], &out.next.clock,
                            &out.next.swing_time};
  for (int i = 0; i < 4; ++i) {
    forces[i]->StoreSlopes(of_forces + i * in.columns + first);
    after[i]->StoreSlopes(of_feet + i * in.columns + first);
  }
}

void StanceJet(const StanceJetInputs& in, double* of_forces, double* of_feet) {
  std::ptrdiff_t first = 0;
  for (; first + kMostColumns <= in.columns; first += kMostColumns) {
    StanceJetOf<kMostColumns>(in, first, of_forces, of_feet);
  }
  if (first < in.columns) StanceJetOf<kLeastColumns>(in, first, of_forces, of_feet);
}

}  // namespace
}  // namespace pushid
