// residuals: what learned forces do that a gain could do: their regression on the forces of gains.
//
// The network is given the measured states of every recording, and its forces are regressed on what
// one unit of each gain would do. A network whose coefficients are far from zero does what a gain
// could do, and the gain loses its meaning. Reported beside a fit.
#pragma once

#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/learned_terms.h"
#include "models/options.h"

namespace pushid {

// Of a self-force network: F_x, F_y on -xd, -yd (mu), F_theta on -e_theta and -thd (Kp_theta,
// Kd_theta), each for the reference person (self_force.h).
struct Takeover {
  double mu = 0.0;         // N s/m
  double kp_theta = 0.0;   // N m/rad
  double kd_theta = 0.0;   // N m s/rad
  double rms_force = 0.0;  // of the network on the cart over mass, m/s^2
};

// Of a learned interaction: the forces on both people on those of a spring of 1 N/m and of a
// damping of 1 N s/m (contact.h), at frames where they load each other.
struct ContactTakeover {
  double stiffness = 0.0;  // N/m
  double damping = 0.0;    // N s/m
  double rms_force = 0.0;  // of the network on a loaded cart over mass, m/s^2
};

// model.learned must have a self force.
Takeover TakeoverOf(const std::vector<PendulumRecording>& recordings, const ModelOptions& model);

// For models with interaction.LearnedBesideContact(). contact: whose distance, reach and height say
// who touches whom.
ContactTakeover ContactTakeoverOf(const std::vector<PendulumRecording>& recordings,
                                  const ModelOptions& model, const ParameterSet<double>& contact);

}  // namespace pushid
