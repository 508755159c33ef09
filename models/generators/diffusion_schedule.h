// models: how much of a motion is left after t of T steps of forward noise, and the way back.
//
//   x_t = sqrt(a_t) x_0 + sqrt(1 - a_t) e,  e ~ N(0, 1)
//   a_t = f(t) / f(0),  f(t) = cos^2((t / T + s) / (1 + s) pi / 2)   the cosine schedule, s = 0.008
//
// The network estimates x_0 itself. From an estimate at t to an earlier time u < t:
//
//   renoised   x_u = sqrt(a_u) x_0 + sqrt(1 - a_u) e, e drawn anew (Eq. 5 of SDM)
//   ddpm       the posterior of x_u given x_t and x_0
//   ddim       x_u = sqrt(a_u) x_0 + sqrt(1 - a_u) e, e = what of x_t is noise by the estimate
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/enum_names.h"

namespace pushid {

enum class DiffusionSampler { kRenoised, kDdpm, kDdim };
constexpr EnumNames<DiffusionSampler, 3> Names(DiffusionSampler) {
  return {{{"renoised", DiffusionSampler::kRenoised},
           {"ddpm", DiffusionSampler::kDdpm},
           {"ddim", DiffusionSampler::kDdim}}};
}

inline constexpr int kDiffusionTime = 1000;  // T

// a_t; 1 at t = 0, 0 at t = T.
inline double SignalShare(double t) {
  constexpr double kOffset = 0.008;
  const auto f = [](double time) {
    return std::pow(std::cos((time / kDiffusionTime + kOffset) / (1.0 + kOffset) * M_PI_2), 2);
  };
  return std::clamp(f(t) / f(0.0), 0.0, 1.0);
}

// x_u = estimate * x_0 + noisy * x_t + noise * e.
struct BackwardStep {
  double estimate = 0.0, noisy = 0.0, noise = 0.0;
};
inline BackwardStep StepBack(DiffusionSampler sampler, double t, double u) {
  const double a = SignalShare(t), b = SignalShare(u);
  if (u <= 0.0) return {1.0, 0.0, 0.0};
  switch (sampler) {
    case DiffusionSampler::kRenoised:
      return {std::sqrt(b), 0.0, std::sqrt(1.0 - b)};
    case DiffusionSampler::kDdpm: {
      const double left = (1.0 - b) / (1.0 - a), step = a / b;  // of x_u in x_t
      return {std::sqrt(b) * (1.0 - step) / (1.0 - a), std::sqrt(step) * left,
              std::sqrt(left * (1.0 - step))};
    }
    case DiffusionSampler::kDdim: {
      const double share = std::sqrt((1.0 - b) / (1.0 - a));
      return {std::sqrt(b) - share * std::sqrt(a), share, 0.0};
    }
  }
  return {};
}

}  // namespace pushid
