// models: pushes as generalized forces [N, N, N m, N m] on one person, frame by frame.
//
// A `net` push covers only the first part of the real one. Its tail goes on after the last row as
//   F(k) = [(g + s) Fx, (g + s) Fy, r (1 + s) Ftheta, r (1 + s) Fphi] exp(-k dt / tau),
//   tau = t (d / 0.1 s)^e,   s = b M / (tau |F|),   |F| = |[Fx, Fy]|,
// with F the mean of the n rows, k = frames since the end, g = tail_gain, r = tail_torque,
// t = tail_time, e = tail_exponent, d = n dt, at most 0.4 s: the published pushes are no longer,
// and a tail that kept growing would send people away who are pushed weakly for long. b = tail_base
// is what does not depend on how hard the rows push: a pusher pushes on until the person, of mass
// M, moves. Together its force gives the person the speed b. An external push has no tail. Where
// feet stand (stance.h) the tail goes on as what it is, a horizontal force
// [(g + s) Fx, (g + s) Fy] exp(-k dt / tau) at the hip: r is what sliding feet make of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "models/enum_names.h"
#include "models/ipm.h"
#include "models/parameters.h"

namespace pushid {

// The meaning of a push's rows.
enum class PushKind {
  kNet,                 // the whole generalized force on the pushed person while it lasts
  kNetWithoutFriction,  // inverse dynamics with the ground friction taken out: net = push +
                        // friction
  kExternal,            // a measured force, added to everything else
};
constexpr EnumNames<PushKind, 3> Names(PushKind) {
  return {{{"net", PushKind::kNet},
           {"net_without_friction", PushKind::kNetWithoutFriction},
           {"external", PushKind::kExternal}}};
}

inline constexpr double kTailReferenceDuration = 0.1, kLongestTailDuration = 0.4;  // s

// A push in a scene; row i drives the step from frame start_frame + i to the next.
struct ScenePush {
  int person = 0;
  int start_frame = 0;
  PushKind kind = PushKind::kExternal;
  std::vector<Vector4<double>> force;
  Vector4<double> mean = Vector4<double>::Zero();  // of the rows; set by MakeScenePush

  int EndFrame() const { return start_frame + static_cast<int>(force.size()); }
  bool Active(int frame) const { return frame >= start_frame && frame < EndFrame(); }
};

// A push ends with its last row that is not zero, if it has one: files may pad it to the length of
// a recording.
inline ScenePush MakeScenePush(int person, int start_frame, PushKind kind,
                               std::vector<Vector4<double>> force) {
  const auto last = std::find_if(force.rbegin(), force.rend(),
                                 [](const Vector4<double>& row) { return !row.isZero(0.0); });
  if (last != force.rend()) force.erase(last.base(), force.end());
  ScenePush push{person, start_frame, kind, std::move(force)};
  for (const Vector4<double>& row : push.force) push.mean += row;
  if (!push.force.empty()) push.mean /= static_cast<double>(push.force.size());
  return push;
}

// log(d / 0.1 s) for a push of so many seconds.
double LogTailDuration(double push_duration);

// The tail's decay time in seconds.
template <typename T, typename L>
T TailDecayTime(const ParameterSet<T>& p, const L& log_duration) {
  using std::exp;
  return p[kTailTime] * exp(p[kTailExponent] * log_duration);
}

// Whether a push has a tail at `frame`: not before it ends, and not an external one.
inline bool TailActs(const ScenePush& push, int frame) {
  return push.kind != PushKind::kExternal && !push.force.empty() && frame >= push.EndFrame();
}

// A tail that acts, so long after its push; L as in ipm.h.
template <typename L>
struct TailOf {
  Vector4<L> mean;
  L mass_per_force;  // M / |F|; 0 of a push without horizontal force
  L log_duration;    // LogTailDuration of the push
  L elapsed;         // s, since the push ended

  // 1 / tau, which stays the same, and what is left at that rate.
  template <typename T>
  T Rate(const ParameterSet<T>& p) const {
    return 1.0 / TailDecayTime(p, log_duration);
  }
  template <typename T>
  T Decay(const T& rate) const {
    using std::exp;
    return exp(-elapsed * rate);
  }
  // s above.
  template <typename T>
  T BaseShare(const ParameterSet<T>& p, const T& rate) const {
    return p[kTailBase] * mass_per_force * rate;
  }
  // The remaining force over the mean of the rows' horizontal force.
  template <typename T>
  T Gain(const ParameterSet<T>& p) const {
    const T rate = Rate(p);
    return (p[kTailGain] + BaseShare(p, rate)) * Decay(rate);
  }
  template <typename T>
  Vector4<T> Force(const ParameterSet<T>& p, const T& rate, const T& decay) const {
    const T share = BaseShare(p, rate);
    const T gain = (p[kTailGain] + share) * decay;
    const T torque = p[kTailTorque] * (1.0 + share) * decay;
    return {gain * mean[0], gain * mean[1], torque * mean[2], torque * mean[3]};
  }
};

// The tail of a push on a person of so many kg that has one at `frame` (TailActs).
TailOf<double> TailAt(const ScenePush& push, double mass, int frame, double dt);

// The tail's force at `frame`; zero where it does not act.
template <typename T>
Vector4<T> TailForce(const ScenePush& push, double mass, const ParameterSet<T>& p, int frame,
                     double dt) {
  if (!TailActs(push, frame)) return Vector4<T>::Zero();
  const TailOf<double> tail = TailAt(push, mass, frame, dt);
  const T rate = tail.Rate(p);
  return tail.Force(p, rate, tail.Decay(rate));
}

// Makes the tail's force so many times as large, and its torque at least (the base's torque is a
// product of two of these).
inline void ScaleTail(double factor, ParameterSet<double>* p) {
  for (Parameter id : {kTailGain, kTailTorque, kTailBase}) (*p)[id] *= factor;
}

// The horizontal impulse of a push's tail, N s; 0 of a push without one.
double TailImpulse(const ScenePush& push, double mass, const ParameterSet<double>& p, double dt);
// The horizontal impulse of a push with its tail, N s.
double WholeImpulse(const ScenePush& push, double mass, const ParameterSet<double>& p, double dt);

// A force f (N, world) at the fraction `height` of the rod, as a generalized force.
template <typename T>
Vector4<T> GeneralizedForce(const Body& body, const Angles<T>& angles, const Vector3<T>& f,
                            double height) {
  const double al = height * body.rod_length;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  return {f[0], f[1], al * (f[0] * c_th + f[1] * s_th * s_ph - f[2] * s_th * c_ph),
          al * (-f[1] * c_th * c_ph - f[2] * c_th * s_ph)};
}

template <typename T>
Vector4<T> GeneralizedForce(const Body& body, const Vector4<T>& q, const Vector3<T>& f,
                            double height) {
  return GeneralizedForce<T>(body, Angles<T>(q), f, height);
}

// The tail's force where feet stand: at the hip.
template <typename T>
Vector4<T> TailForceAtHip(const ScenePush& push, const ParameterSet<T>& p, const Body& body,
                          const Angles<T>& angles, int frame, double dt) {
  if (!TailActs(push, frame)) return Vector4<T>::Zero();
  const T gain = TailAt(push, body.mass, frame, dt).Gain(p);
  return GeneralizedForce<T>(body, angles, {gain * push.mean[0], gain * push.mean[1], T(0.0)}, 1.0);
}

// A half-sine of `frames` rows along +x at the hip of an upright person, of the named impulse (N
// s).
std::vector<Vector4<double>> HalfSinePush(const Body& body, double impulse, int frames, double dt);

}  // namespace pushid
