// models: the scale on which a parameter is fitted.
#pragma once

#include <cmath>

#include "models/enum_names.h"

namespace pushid {

enum class Transform {
  kIdentity,
  kLog,   // positive parameters
  kLogit  // unit interval
};
constexpr EnumNames<Transform, 3> Names(Transform) {
  return {
      {{"identity", Transform::kIdentity}, {"log", Transform::kLog}, {"logit", Transform::kLogit}}};
}

template <typename T>
T ToNatural(Transform transform, const T& fitted) {
  using std::exp;
  switch (transform) {
    case Transform::kLog:
      return exp(fitted);
    case Transform::kLogit:
      return 1.0 / (1.0 + exp(-fitted));
    case Transform::kIdentity:
      break;
  }
  return fitted;
}

inline double ToFitted(Transform transform, double natural) {
  if (transform == Transform::kLog) return std::log(natural);
  if (transform == Transform::kLogit) return std::log(natural / (1.0 - natural));
  return natural;
}

// d natural / d fitted, at a natural value.
inline double TransformSlope(Transform transform, double natural) {
  if (transform == Transform::kLog) return natural;
  if (transform == Transform::kLogit) return natural * (1.0 - natural);
  return 1.0;
}

}  // namespace pushid
