// models: the one jet: a number with its derivatives by N columns, over any scalar T, itself a
// scalar of the models' templates. models knows no solver and hence no ceres::Jet; and a path's
// action (likelihood_residual.h) needs derivatives by the state whose own derivatives by the nodes
// are Jets, which ceres' own do not mix with plain doubles. Only what force terms are made of is
// here.
//
// Doubles are moved in the vectors of the processor: a file that is compiled for wider ones says,
// before it includes this,
//   PUSHID_VECTOR_DOUBLES      doubles in a vector; else 2, which every processor has
// A type without linkage, so that what is made of it stays in that file too
// (tests/residuals/shared_code.sh). It allocates nothing, and every operation is the same sum of
// products, whatever the width of the vectors: without contraction (-ffp-contract=off) the bits are
// equal on all processors.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

namespace pushid {
namespace {

#ifdef PUSHID_VECTOR_DOUBLES
constexpr int kJetDoubles = PUSHID_VECTOR_DOUBLES;
#else
constexpr int kJetDoubles = 2;
#endif

// Derivatives that are moved at once: kEach of them in a Part.
template <typename T>
struct JetPart {
  using Part = T;
  static constexpr int kEach = 1;
};
template <>
struct JetPart<double> {
  // Aligned as doubles are: containers know of no wider alignment.
  using Part = double __attribute__((vector_size(8 * kJetDoubles), aligned(8)));
  static constexpr int kEach = kJetDoubles;
};

template <typename T, int N>
struct JetOf {
  using Part = typename JetPart<T>::Part;
  static constexpr int kEach = JetPart<T>::kEach, kParts = (N + kEach - 1) / kEach, kColumns = N;

  T a;             // the value
  Part v[kParts];  // its derivatives

  JetOf() = default;
  JetOf(double constant) : a(constant) {  // NOLINT: has no derivatives
    for (Part& part : v) part = Part{};
  }
  static JetOf Constant(const T& value) {
    JetOf constant(0.0);
    constant.a = value;
    return constant;
  }
  // Input number `column`.
  static JetOf Input(const T& value, int column) {
    JetOf input = Constant(value);
    input.AddSlope(column, T(1.0));
    return input;
  }
  T Slope(int column) const {
    if constexpr (kEach == 1) {
      return v[column];
    } else {
      return v[column / kEach][column % kEach];
    }
  }
  void AddSlope(int column, const T& slope) {
    if constexpr (kEach == 1) {
      v[column] += slope;
    } else {
      v[column / kEach][column % kEach] += slope;
    }
  }
  void StoreSlopes(double* to) const { __builtin_memcpy(to, v, sizeof(v)); }

  JetOf& operator+=(const JetOf& y) { return *this = *this + y; }
  JetOf& operator-=(const JetOf& y) { return *this = *this - y; }
  JetOf& operator*=(const JetOf& y) { return *this = *this * y; }
  JetOf& operator/=(const JetOf& y) { return *this = *this / y; }

  // value, with the derivatives of c x + d y.
  static JetOf Sum(const T& value, const T& c, const JetOf& x, const T& d, const JetOf& y) {
    JetOf sum;
    sum.a = value;
    for (int i = 0; i < kParts; ++i) sum.v[i] = c * x.v[i] + d * y.v[i];
    return sum;
  }
  // value, with the derivatives of c x.
  template <typename C>
  static JetOf Scaled(const T& value, const C& c, const JetOf& x) {
    JetOf scaled;
    scaled.a = value;
    for (int i = 0; i < kParts; ++i) scaled.v[i] = c * x.v[i];
    return scaled;
  }

  JetOf operator-() const { return Scaled(-a, -1.0, *this); }
  friend JetOf operator+(const JetOf& x, const JetOf& y) {
    JetOf sum;
    sum.a = x.a + y.a;
    for (int i = 0; i < kParts; ++i) sum.v[i] = x.v[i] + y.v[i];
    return sum;
  }
  friend JetOf operator-(const JetOf& x, const JetOf& y) {
    JetOf difference;
    difference.a = x.a - y.a;
    for (int i = 0; i < kParts; ++i) difference.v[i] = x.v[i] - y.v[i];
    return difference;
  }
  friend JetOf operator*(const JetOf& x, const JetOf& y) { return Sum(x.a * y.a, y.a, x, x.a, y); }
  friend JetOf operator/(const JetOf& x, const JetOf& y) {
    const T inverse = 1.0 / y.a, value = x.a / y.a;
    return Sum(value, inverse, x, -value * inverse, y);
  }
  // Operations with a constant, which has no derivatives to carry.
  friend JetOf operator+(JetOf x, double c) { return x.a += c, x; }
  friend JetOf operator+(double c, JetOf x) { return x.a = c + x.a, x; }
  friend JetOf operator-(JetOf x, double c) { return x.a -= c, x; }
  friend JetOf operator-(double c, const JetOf& x) { return Scaled(c - x.a, -1.0, x); }
  friend JetOf operator*(const JetOf& x, double c) { return Scaled(x.a * c, c, x); }
  friend JetOf operator*(double c, const JetOf& x) { return Scaled(c * x.a, c, x); }
  friend JetOf operator/(const JetOf& x, double c) { return Scaled(x.a / c, 1.0 / c, x); }
  friend JetOf operator/(double c, const JetOf& x) { return Scaled(c / x.a, -c / (x.a * x.a), x); }
  template <typename C,
            std::enable_if_t<std::is_same_v<C, T> && !std::is_same_v<C, double>, int> = 0>
  friend JetOf operator*(const C& c, const JetOf& x) {
    return Scaled(c * x.a, c, x);
  }

  friend JetOf sqrt(const JetOf& x) {
    using std::sqrt;
    const T root = sqrt(x.a);
    return Scaled(root, T(0.5 / root), x);
  }
  friend JetOf exp(const JetOf& x) {
    using std::exp;
    const T value = exp(x.a);
    return Scaled(value, value, x);
  }
  friend JetOf log(const JetOf& x) {
    using std::log;
    return Scaled(log(x.a), T(1.0 / x.a), x);
  }
  friend JetOf tanh(const JetOf& x) {
    using std::tanh;
    const T value = tanh(x.a);
    return Scaled(value, T(1.0 - value * value), x);
  }
  friend JetOf sin(const JetOf& x) {
    using std::cos, std::sin;
    return Scaled(sin(x.a), T(cos(x.a)), x);
  }
  friend JetOf cos(const JetOf& x) {
    using std::cos, std::sin;
    return Scaled(cos(x.a), T(-sin(x.a)), x);
  }
};

// The jet of rollouts: a pass of eight columns.
using VectorJet = JetOf<double, 8>;

}  // namespace

// Real part, whatever the scalar: a double, a jet, one over the other.
inline double RealPart(double value) { return value; }
template <typename Scalar>
double RealPart(const Scalar& value) {
  return RealPart(value.a);
}

// How many times a scalar carries derivatives: 0 for doubles, 1 for jets, 2 for jets over jets.
template <typename Scalar>
struct DerivativeOrder {
  static constexpr int value = 1 + DerivativeOrder<decltype(Scalar::a)>::value;
};
template <>
struct DerivativeOrder<double> {
  static constexpr int value = 0;
};

}  // namespace pushid

template <typename T, int N>
struct Eigen::NumTraits<pushid::JetOf<T, N>> : Eigen::NumTraits<double> {
  using Real = pushid::JetOf<T, N>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum {
    RequireInitialization = NumTraits<T>::RequireInitialization,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
template <typename T, int N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, pushid::JetOf<T, N>, Operation> {
  using ReturnType = pushid::JetOf<T, N>;
};
template <typename T, int N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<pushid::JetOf<T, N>, double, Operation> {
  using ReturnType = pushid::JetOf<T, N>;
};
