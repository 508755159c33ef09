// ident: the Kalman filter of a rollout's error.
#include "ident/fit/error_process.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

constexpr double kReferenceTime = 31.0 / 60.0;  // s, where var p = 1
constexpr double kNoise = 0.05;                 // of y, on that scale

}  // namespace

ErrorProcess::ErrorProcess(double dt) : dt_(dt), decay_(std::exp(-dt / kErrorTime)) {
  drive_ = 1.0 - decay_ * decay_;
  Covariance at;
  const long frames = std::max(1L, std::lround(kReferenceTime / dt));
  for (long t = 0; t < frames; ++t) at = Advanced(at);
  drive_ /= at.pp;
}

ErrorProcess::Covariance ErrorProcess::Advanced(const Covariance& now) const {
  const double vv = decay_ * decay_ * now.vv + drive_;
  const double pv = decay_ * now.pv;  // of p_t-1 and v_t
  return {now.pp + 2.0 * dt_ * pv + dt_ * dt_ * vv, pv + dt_ * vv, vv};
}

ErrorProcess::Gains ErrorProcess::Next(bool seen) {
  now_ = Advanced(now_);
  if (!seen) return {};
  const double variance = now_.pp + kNoise * kNoise;
  const Gains gains = {now_.pp / variance, now_.pv / variance, variance};
  now_ = {now_.pp - gains.position * now_.pp, now_.pv - gains.position * now_.pv,
          now_.vv - gains.velocity * now_.pv};
  return gains;
}

ErrorProcess::State ErrorProcess::Predicted(const State& state) const {
  const double velocity = decay_ * state.velocity;
  return {state.position + dt_ * velocity, velocity};
}

double ErrorProcess::Reach(int frames) const {
  return dt_ * decay_ * (1.0 - std::pow(decay_, frames)) / (1.0 - decay_);  // r + ... + r^frames
}

std::vector<double> ErrorProcess::VariancesAhead(int frames) const {
  std::vector<double> variances;
  Covariance at = now_;
  for (int t = 0; t < frames; ++t) {
    at = Advanced(at);
    variances.push_back(at.pp + kNoise * kNoise);
  }
  return variances;
}

}  // namespace pushid
