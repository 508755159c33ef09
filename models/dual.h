// models: dual numbers: a value with its first derivatives by N inputs, over any scalar T.
//
// models knows no solver and hence no ceres::Jet; and a path's action (likelihood_residual.h) needs
// derivatives by the state whose own derivatives by the nodes are Jets: Dual<Jet, N>. Jets of Jets
// do not mix with plain doubles; these do. Only what force terms are made of is here.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

namespace pushid {

template <typename T, int N>
struct Dual {
  T a;                       // the value
  Eigen::Matrix<T, N, 1> v;  // its derivatives

  Dual(double value = 0.0) : a(value) { v.setConstant(T(0.0)); }  // NOLINT: a constant
  Dual(const T& value, const Eigen::Matrix<T, N, 1>& derivatives) : a(value), v(derivatives) {}
  // Input number k.
  static Dual Input(const T& value, int k) {
    Dual x = Constant(value);
    x.v[k] = T(1.0);
    return x;
  }
  static Dual Constant(const T& value) {
    Dual x;
    x.a = value;
    return x;
  }

  const T& Slope(int k) const { return v[k]; }

  Dual operator-() const { return {-a, -v}; }
  Dual& operator+=(const Dual& y) { return *this = *this + y; }
  Dual& operator-=(const Dual& y) { return *this = *this - y; }
  Dual& operator*=(const Dual& y) { return *this = *this * y; }
  Dual& operator/=(const Dual& y) { return *this = *this / y; }

  friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  friend Dual operator*(const Dual& x, const Dual& y) { return {x.a * y.a, y.a * x.v + x.a * y.v}; }
  friend Dual operator/(const Dual& x, const Dual& y) {
    const T value = x.a / y.a;
    return {value, (x.v - value * y.v) / y.a};
  }
  // By a constant, which has no derivatives to carry.
  friend Dual operator*(double c, const Dual& x) { return x.Scaled(T(c)); }
  template <typename C,
            std::enable_if_t<std::is_same_v<C, T> && !std::is_same_v<C, double>, int> = 0>
  friend Dual operator*(const C& c, const Dual& x) {
    return x.Scaled(c);
  }
  friend Dual operator*(const Dual& x, double c) { return x.Scaled(T(c)); }
  friend Dual operator/(const Dual& x, double c) { return {x.a / T(c), x.v / T(c)}; }

  // f(x) from f and f' at the value.
  Dual Through(const T& value, const T& slope) const { return {value, slope * v}; }

  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const T root = sqrt(x.a);
    return x.Through(root, T(0.5) / root);
  }
  friend Dual exp(const Dual& x) {
    using std::exp;
    const T value = exp(x.a);
    return x.Through(value, value);
  }
  friend Dual tanh(const Dual& x) {
    using std::tanh;
    const T value = tanh(x.a);
    return x.Through(value, T(1.0) - value * value);
  }
  friend Dual sin(const Dual& x) {
    using std::cos, std::sin;
    return x.Through(sin(x.a), cos(x.a));
  }
  friend Dual cos(const Dual& x) {
    using std::cos, std::sin;
    return x.Through(cos(x.a), -sin(x.a));
  }

 private:
  Dual Scaled(const T& c) const { return {c * a, c * v}; }
};

// Real part, whatever the scalar: a double, a Jet, a Dual, one over the other.
inline double RealPart(double value) { return value; }
template <typename Scalar>
double RealPart(const Scalar& value) {
  return RealPart(value.a);
}

// How many times a scalar carries derivatives: 0 for doubles, 1 for Jets, 2 for Duals over Jets.
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
struct Eigen::NumTraits<pushid::Dual<T, N>> : Eigen::NumTraits<double> {
  using Real = pushid::Dual<T, N>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum { RequireInitialization = 1, ReadCost = N, AddCost = N, MulCost = 2 * N };
};
