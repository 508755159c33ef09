// models: a person pushed by others steps on for a while: the counterpart, for people pushed by
// people, of the push tail (push.h).
//
// With F the generalized force of the interaction and w what was received lately,
//   w' = (F - w) / tau,   F_drive = [g w_x, g w_y, r w_theta, r w_phi],
// g = drive_gain, r = drive_torque, tau = drive_time; exact over a frame with F held. It dies out
// with the contact, so it cannot keep anybody walking, unlike a force that feeds on the own motion.
#pragma once

#include <cmath>

#include "models/ipm.h"
#include "models/parameters.h"

namespace pushid {

// What is left of w after one frame.
template <typename T>
T DriveMemory(const ParameterSet<T>& p, double dt) {
  using std::exp;
  return exp(-dt / p[kDriveTime]);
}

template <typename T>
Vector4<T> NextReceived(const ParameterSet<T>& p, const Vector4<T>& received,
                        const Vector4<T>& interaction, double dt) {
  const T memory = DriveMemory(p, dt);
  return memory * received + (1.0 - memory) * interaction;
}

template <typename T>
Vector4<T> DriveForce(const ParameterSet<T>& p, const Vector4<T>& received) {
  return {p[kDriveGain] * received[0], p[kDriveGain] * received[1], p[kDriveTorque] * received[2],
          p[kDriveTorque] * received[3]};
}

}  // namespace pushid
