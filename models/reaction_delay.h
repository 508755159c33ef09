// models: control acts on what a person was a reaction time ago, and muscles on what they are.
//
// Active feedback acts on the state at t - d, passive stiffness and damping on that at t:
//   tau = -(K e + D e')(t - d) (1 - s) - (K e + D e')(t) s
// with s the passive share of the stiffness and of the damping, so that K and D are the whole
// gains, comparable with those of a model without a delay. Control is therefore given what is
// perceived,
//   e_p = s_K e(t) + (1 - s_K) e(t - d),   e_p' = s_D e'(t) + (1 - s_D) e'(t - d),
// and is else as without a delay. Stepping (the rows of the cart, and where feet step the capture
// point) has no passive share, and a delay of its own with Delay::kAnkleAndStep.
//
// Between frames the state is a cubic through its neighbours (Catmull and Rom 1974; at the present
// end the tangent is one-sided): smooth in d, so that d can be fitted. Before frame 0 people were
// at rest in the posture of frame 0. Source of the model: Masani et al., J. Neurophysiol. 2003;
// Peterka, J. Neurophysiol. 2002 (delays of 0.1 to 0.2 s).
#pragma once

#include <algorithm>
#include <cmath>

#include "models/frame_table.h"
#include "models/parameters.h"

namespace pushid {

// What a delayed state is made of: `weight[i]` times the state at `frame - i`, and the same of its
// derivative by the delay, 1/s.
template <typename T>
struct DelayedFrames {
  static constexpr int kCount = 4;
  int frame;
  T weight[kCount];
  T by_delay[kCount];

  DelayedFrames(const T& delay, int now, double dt) {
    const double whole = std::floor(RealPart(delay) / dt);
    const int k = static_cast<int>(whole);
    const T u = delay * (1.0 / dt) - whole;
    const T u2 = u * u, u3 = u2 * u;
    // Values 1 .. 2 are beside t - d; 0 is later than both, 3 earlier.
    const T w0 = 0.5 * (-u + 2.0 * u2 - u3), s0 = 0.5 * (-1.0 + 4.0 * u - 3.0 * u2);
    const T w1 = 0.5 * (2.0 - 5.0 * u2 + 3.0 * u3), s1 = 0.5 * (-10.0 * u + 9.0 * u2);
    const T w2 = 0.5 * (u + 4.0 * u2 - 3.0 * u3), s2 = 0.5 * (1.0 + 8.0 * u - 9.0 * u2);
    const T w3 = 0.5 * (-u2 + u3), s3 = 0.5 * (-2.0 * u + 3.0 * u2);
    const T w[] = {w0, w1, w2, w3}, s[] = {s0, s1, s2, s3};
    frame = now - k + 1;
    for (int i = 0; i < kCount; ++i) weight[i] = w[i], by_delay[i] = s[i] * (1.0 / dt);
    if (k > 0) return;
    // What is later than now is on the line through the two before: twice the one less the other.
    frame = now;
    const T first[] = {w1 + 2.0 * w0, w2 - w0, w3, T(0.0)};
    const T slope[] = {s1 + 2.0 * s0, s2 - s0, s3, T(0.0)};
    for (int i = 0; i < kCount; ++i) weight[i] = first[i], by_delay[i] = slope[i] * (1.0 / dt);
  }
};

// The state so long before `now`, and its derivative by the delay.
template <typename T>
struct DelayedState {
  Vector4<T> q, qd, q_by_delay, qd_by_delay;

  DelayedState(const RolloutPath<T>& path, int person, const DelayedFrames<T>& frames) {
    q.setConstant(T(0.0));
    qd = q_by_delay = qd_by_delay = q;
    for (int i = 0; i < DelayedFrames<T>::kCount; ++i) {
      const int at = frames.frame - i;
      const PendulumState<T>& state = path.At(std::max(at, 0), person);
      q += frames.weight[i] * state.q;
      q_by_delay += frames.by_delay[i] * state.q;
      if (at < 0) continue;
      qd += frames.weight[i] * state.qd;
      qd_by_delay += frames.by_delay[i] * state.qd;
    }
  }
};

// What control acts on: of the ankles (angles and their rates), and of steps.
template <typename T>
struct Perceived {
  PendulumState<T> ankle, step;

  Perceived() = default;
  Perceived(const PendulumState<T>& now)  // NOLINT: without a delay
      : ankle(now), step(now) {}
};

// Which delay steps have.
constexpr Parameter StepDelayOf(Delay delay) {
  return delay == Delay::kAnkleAndStep ? kStepDelay : kReactionDelay;
}

// now: the path's last known frame.
template <typename T>
Perceived<T> Perceive(Delay delay, const ParameterSet<T>& p, const RolloutPath<T>& path, int now,
                      int person, double dt) {
  const PendulumState<T>& state = path.At(now, person);
  Perceived<T> perceived(state);
  if (delay == Delay::kNone) return perceived;
  const DelayedState<T> ankle(path, person, DelayedFrames<T>(p[kReactionDelay], now, dt));
  perceived.ankle.q = ankle.q;
  perceived.ankle.qd = ankle.qd;
  for (int i = 2; i < 4; ++i) {
    perceived.ankle.q[i] = ankle.q[i] + p[kPassiveStiffness] * (state.q[i] - ankle.q[i]);
    perceived.ankle.qd[i] = ankle.qd[i] + p[kPassiveDamping] * (state.qd[i] - ankle.qd[i]);
  }
  const DelayedState<T> step(path, person, DelayedFrames<T>(p[StepDelayOf(delay)], now, dt));
  perceived.step.q = step.q;
  perceived.step.qd = step.qd;
  return perceived;
}

}  // namespace pushid
