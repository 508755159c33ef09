// models: process noise: white generalized forces that drive a person beside all that the model
// knows.
//   M(q) qdd + C + G = F_net + L w,  w white of unit intensity
//   L = (M / 85 kg) (1 + k_v |v|) k_p diag(sigma) U
// sigma in N sqrt(s) and N m sqrt(s), U unit lower triangular (diagonal noise: U = 1), k_p while a
// push acts on the person (otherwise 1), v the cart's velocity. Over a step of dt seconds w is
// constant and N(0, 1/dt). This is dS = f dt + g dW of Lyu et al., ACM MM 2021 (Eq. 1), with
// S = [q, qd] and g = [0; M^-1 L]: what is not known acts as forces do, and moves nobody's place
// without moving their velocity.
#pragma once

#include <cmath>
#include <functional>

#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/scene.h"

namespace pushid {

// Whether a push's rows act on a person in one step.
inline bool Pushed(const Scene& scene, int person, int frame) {
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person && push.Active(frame)) return true;
  }
  return false;
}

// L, lower triangular; N sqrt(s) and N m sqrt(s).
template <typename T>
Matrix4<T> NoiseFactor(const ProcessNoiseTerms& terms, const Body& body, const ParameterSet<T>& p,
                       const Vector4<T>& qd, bool pushed) {
  using std::sqrt;
  constexpr double kStill = 1e-6;  // m^2/s^2: |v| has no derivative at 0
  T scale = T(body.mass / kReferenceMass);
  if (terms.speed) {
    scale *= 1.0 + p[kNoiseSpeed] * (sqrt(qd[0] * qd[0] + qd[1] * qd[1] + kStill) - 1e-3);
  }
  if (terms.push && pushed) scale *= p[kNoisePush];
  Matrix4<T> factor = Matrix4<T>::Zero();
  int at = kNoiseYX;
  for (int i = 0; i < 4; ++i) {
    const T sigma = scale * p[kSigmaX + i];
    for (int j = 0; terms.full && j < i; ++j, ++at) factor(i, j) = sigma * p[at];
    factor(i, i) = sigma;
  }
  return factor;
}

// Of the measured q about the true one, where cart and hip are measured with independent errors on
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

// Where random numbers come from; models hold no random generator of their own.

// Standard normal draws.
using NormalSource = std::function<double()>;

}  // namespace pushid
