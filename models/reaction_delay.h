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
// The rates of semi-implicit Euler are those between two frames: qd of frame t is the rate at
// t - dt / 2, and that at t is extrapolated from it and the one before. (Taken for those at frames,
// they come half a frame late, and a fit makes up for it by a passive share that is dt / 2 d too
// large.)
//
// Between frames the state is a cubic through its neighbours (Catmull and Rom 1974; at the present
// end the tangent is one-sided): smooth in d, so that d can be fitted. Before frame 0 people were
// at rest in the posture of frame 0. Source of the model: Masani et al., J. Neurophysiol. 2003;
// Peterka, J. Neurophysiol. 2002 (delays of 0.1 to 0.2 s).
#pragma once

#include <algorithm>
#include <cmath>

#include "models/ipm.h"
#include "models/jet.h"
#include "models/parameters.h"

namespace pushid {

// Parts of a delayed state: `weight[i]` times the state `back + i` frames ago.
template <typename T>
struct DelayedFrames {
  static constexpr int kCount = 4;
  int back;
  T weight[kCount];

  DelayedFrames(const T& delay, double dt) {
    const double whole = std::floor(RealPart(delay) / dt);
    const int k = static_cast<int>(whole);
    const T u = delay * (1.0 / dt) - whole;
    const T u2 = u * u, u3 = u2 * u;
    // Values 1 .. 2 are beside t - d; 0 is later than both, 3 earlier.
    const T w[] = {0.5 * (-u + 2.0 * u2 - u3), 0.5 * (2.0 - 5.0 * u2 + 3.0 * u3),
                   0.5 * (u + 4.0 * u2 - 3.0 * u3), 0.5 * (-u2 + u3)};
    back = k - 1;
    for (int i = 0; i < kCount; ++i) weight[i] = w[i];
    if (k > 0) return;
    // A state later than now is on the line through the two before: twice the one less the other.
    back = 0;
    const T first[] = {w[1] + 2.0 * w[0], w[2] - w[0], w[3], T(0.0)};
    for (int i = 0; i < kCount; ++i) weight[i] = first[i];
  }
};

// Weights of the frames that make a delayed pose and rate; delays below half a frame do not reach
// the rates.
template <typename T>
struct DelayedPlace {
  DelayedFrames<T> of_pose, of_rate;

  DelayedPlace(const T& delay, double dt)
      : of_pose(delay, dt),
        of_rate(RealPart(delay) > 0.5 * dt ? T(delay - 0.5 * dt) : T(0.0), dt) {}
};

// The state so long before frame `now`.
template <typename T>
struct DelayedState {
  Vector4<T> q, qd;

  DelayedState(const RolloutPath<T>& path, int now, int person, const DelayedPlace<T>& place) {
    q.setConstant(T(0.0));
    qd = q;
    for (int i = 0; i < DelayedFrames<T>::kCount; ++i) {
      const PendulumState<T>& pose = path.At(std::max(now - place.of_pose.back - i, 0), person);
      q += place.of_pose.weight[i] * pose.q;
      const int at = now - place.of_rate.back - i;
      if (at < 0) continue;  // at rest
      qd += place.of_rate.weight[i] * path.At(at, person).qd;
    }
  }
};

// The rates at a frame: by so much those of the frame, less the rest of those before.
inline constexpr double kRateAhead = 1.5;
template <typename T>
Vector4<T> PresentRate(const RolloutPath<T>& path, int now, int person) {
  const Vector4<T>& qd = path.At(now, person).qd;
  if (now == 0) return qd;
  return kRateAhead * qd + (1.0 - kRateAhead) * path.At(now - 1, person).qd;
}

// The states that control acts on: of the ankles (angles and their rates), and of steps.
template <typename T>
struct Perceived {
  PendulumState<T> ankle, step;

  Perceived() = default;
  Perceived(const PendulumState<T>& now)  // NOLINT: without a delay
      : ankle(now), step(now) {}
};

// The delay that steps have.
constexpr Parameter StepDelayOf(Delay delay) {
  return delay == Delay::kAnkleAndStep ? kStepDelay : kReactionDelay;
}

// Places of the ankles and of steps: the same in all frames of a rollout.
template <typename T>
struct DelayedPlaces {
  DelayedPlace<T> ankle, step;

  DelayedPlaces(Delay delay, const ParameterSet<T>& p, double dt)
      : ankle(p[kReactionDelay], dt), step(p[StepDelayOf(delay)], dt) {}
};

// now: the path's last known frame.
template <typename T>
Perceived<T> Perceive(const DelayedPlaces<T>& places, const ParameterSet<T>& p,
                      const RolloutPath<T>& path, int now, int person) {
  const PendulumState<T>& state = path.At(now, person);
  Perceived<T> perceived(state);
  const DelayedState<T> ankle(path, now, person, places.ankle);
  const Vector4<T> rate = PresentRate(path, now, person);
  perceived.ankle.q = ankle.q;
  perceived.ankle.qd = ankle.qd;
  for (int i = 2; i < 4; ++i) {
    perceived.ankle.q[i] = ankle.q[i] + p[kPassiveStiffness] * (state.q[i] - ankle.q[i]);
    perceived.ankle.qd[i] = ankle.qd[i] + p[kPassiveDamping] * (rate[i] - ankle.qd[i]);
  }
  const DelayedState<T> step(path, now, person, places.step);
  perceived.step.q = step.q;
  perceived.step.qd = step.qd;
  return perceived;
}

}  // namespace pushid
