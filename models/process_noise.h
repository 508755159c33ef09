// models: process noise: white generalized forces that drive a person beside all that the model
// knows.
//   M(q) qdd + C + G = F_net + L w,  w white of unit intensity
//   L = (M / 85 kg) diag(sigma)
// sigma in N sqrt(s) and N m sqrt(s). Over a step of dt seconds w is
// constant and N(0, 1/dt). This is dS = f dt + g dW of Lyu et al., ACM MM 2021 (Eq. 1), with
// S = [q, qd] and g = [0; M^-1 L]: what is not known acts as forces do, and moves nobody's place
// without moving their velocity.
#pragma once

#include <cmath>
#include <functional>

#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// L; N sqrt(s) and N m sqrt(s).
template <typename T>
Matrix4<T> NoiseFactor(const Body& body, const ParameterSet<T>& p) {
  const T scale = T(body.mass / kReferenceMass);
  Matrix4<T> factor = Matrix4<T>::Zero();
  for (int i = 0; i < 4; ++i) factor(i, i) = scale * p[kSigmaX + i];
  return factor;
}

// Covariance of the measured q about the true one, where cart and hip have independent errors on
// each axis, and the angles follow from both: theta about (hip_x - cart_x) / l, phi about
// -(hip_y - cart_y) / l, to first order.
template <typename T>
Matrix4<T> MeasurementCovariance(const Body& body, const ParameterSet<T>& p) {
  const double l = body.rod_length;
  const T cart = p[kMeasuredCart] * p[kMeasuredCart], hip = p[kMeasuredHip] * p[kMeasuredHip];
  Matrix4<T> covariance = Matrix4<T>::Zero();
  for (int i = 0; i < 2; ++i) {
    covariance(i, i) = cart;
    covariance(2 + i, 2 + i) = (cart + hip) / (l * l);
    covariance(i, 2 + i) = covariance(2 + i, i) = (i == 0 ? -1.0 : 1.0) * cart / l;
  }
  return covariance;
}

// The source of standard normal draws; models hold no random generator of their own.
using NormalSource = std::function<double()>;

}  // namespace pushid
