// datasets: a push beside the motion that it made: direction, size, time, zero.
//
// The point p = 0.9 hip + 0.1 midpoint of the ankles carries a person's mass M. Whoever is pushed
// by a force F goes, at first, along F and at no more than
//   v = J / M,   J = int F dt,
// people who stand as well as those who step: they lose speed to the ground (0.3 to 1.1 J / M was
// simulated), and never gain any. So only the first motion is looked at:
//   onset: p is farther from where it rested than noise and sway go (1 cm at least), and as fast as
//   a quarter of the largest speed; its direction then, and the time by which F alone would have
//   brought it there;
//   gain: the largest speed along J over J / M.
// A net push is the beginning of a push; what it gains is counted while it lasts.
//
// Rejected: the best lag of F's double integral, with drag and stiffness as nuisances: on two-link
// people who stand it was off by 0.1 to 0.3 s, and its gain 0.2.
//
// False alarms of what is found by it: ident/push/README.md.
#pragma once

#include <optional>

#include "datasets/loading/pendulum_recording.h"

namespace pushid {

struct PushAndMotion {
  double speed = 0.0;  // m/s: J / M of the push, with those that overlap it
  // Largest speed along the push over that, and its range: three standard errors of the markers'
  // noise either way.
  double gain = 1.0, least_gain = 1.0, largest_gain = 1.0;
  std::optional<double> angle;  // rad, of the first motion from the push; none: nobody moves
  // s by which the motion starts before (the push is late) or behind the time at which it could:
  // beyond what people's different reactions explain; 0: none.
  double push_late = 0.0, push_early = 0.0;
};

// Of the first push on a person. None: nobody pushes, the force has no horizontal impulse, or
// frames around it were not seen.
std::optional<PushAndMotion> ComparePush(const PendulumRecording& recording, int person);

// What a measured force reads where nobody pulls, N, horizontal: the mean of its last 0.2 s, where
// that is steady and small beside the peak but no noise about zero. 0: none.
double RestingForce(const ScenePush& push, double dt);

// Whether a measured force stops, or the recording does, while it is large.
bool HasNoEnd(const ScenePush& push, int num_frames);

}  // namespace pushid
