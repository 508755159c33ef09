// residuals: what a network does that a gain could do (network_takeover.h, contact_takeover.h).
#pragma once

namespace pushid {

// Of a self-force network.
struct Takeover {
  double mu = 0.0;         // N s/m
  double kp_theta = 0.0;   // N m/rad
  double kd_theta = 0.0;   // N m s/rad
  double rms_force = 0.0;  // of the network on the cart over mass, m/s^2
};

// Of a learned interaction.
struct ContactTakeover {
  double stiffness = 0.0;  // N/m
  double damping = 0.0;    // N s/m
  double rms_force = 0.0;  // of the network on a loaded cart over mass, m/s^2
};

}  // namespace pushid
