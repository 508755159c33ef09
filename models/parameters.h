// models: the physical parameters of one person, by name. A parameter set is a plain array indexed
// by Parameter, so that it can be instantiated for doubles and for automatic differentiation alike.
#pragma once

#include <array>
#include <string_view>

namespace pushid {

// Gains are quoted for the reference person (85 kg, rod 0.95 m); see GainScale in self_force.h.
enum Parameter : int {
  kMu,                 // ground friction, N s/m (x and y; x alone when the friction is anisotropic)
  kMuY,                // ground friction along y, N s/m (anisotropic friction only)
  kKpX,                // balance gain on the cart's velocity, N s/m
  kKpY,                // N s/m
  kKpTheta,            // balance stiffness about y, N m/rad
  kKpPhi,              // balance stiffness about x, N m/rad
  kKdX,                // balance gain on the cart's acceleration (backward difference), kg
  kKdY,                // kg
  kKdTheta,            // balance damping about y, N m s/rad
  kKdPhi,              // balance damping about x, N m s/rad
  kAx,                 // cart force per mass and angle deviation, m/s^2 per rad
  kAy,                 // m/s^2 per rad
  kBx,                 // cart force per mass and angular rate, m/s per rad
  kBy,                 // m/s per rad
  kTx,                 // torque per mass and cart velocity, m/s
  kTy,                 // m/s
  kCq,                 // quadratic damping of the cart per mass, 1/m
  kDq,                 // quadratic damping of the angles over m l^2, 1/rad
  kTailGain,           // push tail: cart force at the push's end over its mean, 1
  kTailTorque,         // push tail: torque at the push's end over its mean, 1
  kTailTime,           // push tail: decay time after a push of 0.1 s, s
  kTailExponent,       // push tail: growth of the decay time with the push's duration, 1
  kContactStiffness,   // between people, N/m
  kContactDistance,    // m
  kContactKappa,       // weight of the distance along y, 1
  kContactDamping,     // N s/m
  kContactHeight,      // fraction of the rod, 1
  kPotentialStrength,  // LDP's repulsive potential, N m
  kPotentialLength,    // its decay length, m
  kNeighbourRange,     // cart distance beyond which LDP's terms vanish, m
  kLeanTheta,          // torque that keeps people from leaning on each other, N m
  kLeanPhi,            // N m
  kDriveGain,          // cart force from the force lately received by contact, 1
  kDriveTorque,        // torque from the torque lately received by contact, 1
  kDriveTime,          // how long "lately" is, s
  kRodLift,            // rise of the cart over the shortening of a rod that moves, 1
  kNumParameters
};

// What two people share: the parameters of the terms between them.
inline constexpr int kFirstPairParameter = kContactStiffness;
inline constexpr int kNumPairParameters = kLeanPhi - kContactStiffness + 1;
constexpr bool IsPairParameter(Parameter id) {
  return id >= kFirstPairParameter && id < kFirstPairParameter + kNumPairParameters;
}

inline constexpr std::array<std::string_view, kNumParameters> kParameterNames = {
    "mu",
    "mu_y",
    "Kp_x",
    "Kp_y",
    "Kp_theta",
    "Kp_phi",
    "Kd_x",
    "Kd_y",
    "Kd_theta",
    "Kd_phi",
    "a_x",
    "a_y",
    "b_x",
    "b_y",
    "t_x",
    "t_y",
    "c_q",
    "d_q",
    "tail_gain",
    "tail_torque",
    "tail_time",
    "tail_exponent",
    "contact_stiffness",
    "contact_distance",
    "contact_kappa",
    "contact_damping",
    "contact_height",
    "potential_strength",
    "potential_length",
    "neighbour_range",
    "lean_theta",
    "lean_phi",
    "drive_gain",
    "drive_torque",
    "drive_time",
    "rod_lift"};

template <typename T>
using ParameterSet = std::array<T, kNumParameters>;

}  // namespace pushid
