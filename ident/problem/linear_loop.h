// ident: a person at rest as a control engineer sees them: transfer functions in closed form, and
// the margins of the loop.
//
// About rest (models/rollout.h) the planes (x, theta) and (y, phi) are separate. With X the cart's
// place and E the angle's deviation, both as the ground sees them, and s = j omega,
//   (M s^2 - J(s)) [X; E] = U,   J(s) = J_now + J_ankle exp(-s d) + J_step exp(-s d_step)
// where J are the derivatives of the forces less gravity by what is felt at once (passive stiffness
// and damping, gravity, the ground) and late (reaction_delay.h). Disturbances are
//   ground shift u, m     U = -M [s^2; 0] u
//   ground tilt u, rad    U = -M [-+ g; s^2] u      (- for theta, + for phi; ground.h)
// The loop is that of the late part of the ankles' torque, which is cut for it:
//   L = -C P,   C = J_ankle's row of the torque times exp(-s d), P = [X; E] by a torque there.
// It is stable as long as L goes around -1 as the body and its passive part need; margins are how
// far that is:
//   phase margin   at |L| = 1, the angle by which L passes -1 (the smallest)
//   delay margin   the smallest of such an angle over its omega: how much more delay until unstable
//   gain margins   1 / |L| where L is real and negative: the factors between which gains may change
// Source: Astrom and Murray, Feedback Systems, 2008, chapter 9; of balance, Peterka, J.
// Neurophysiol. 2002. Modes of a delayed loop: eigenvalues of its generator at Chebyshev's points
// (Breda, Maset and Vermiglio, SIAM J. Sci. Comput. 2005).
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// Causes of motion of a person who stands.
enum class Disturbance { kGroundShift, kGroundTilt };
constexpr EnumNames<Disturbance, 2> Names(Disturbance) {
  return {{{"ground_shift", Disturbance::kGroundShift}, {"ground_tilt", Disturbance::kGroundTilt}}};
}

// Amplitudes of one oscillation, per unit of the disturbance.
struct LoopAnswer {
  std::complex<double> angle;   // rad, of the body in the laboratory
  std::complex<double> torque;  // N m, of the ankles (and of all that acts there but gravity)
};

struct LoopNumbers {
  double stiffness_ratio = 0.0;  // of the ankles' whole stiffness to m g l of the body that turns
  bool stable = false;
  double fastest_growth = 0.0;  // 1/s, largest real part of the modes; not of the free place
  // The oscillating pair that dies out last (or grows fastest); none where nothing oscillates.
  std::optional<double> damping_ratio, natural_hz;
  // Margins: none if the loop is unstable, if |L| is never 1 (phase, delay), or if L is never real
  // and negative on that side (gain).
  std::optional<double> phase_margin;        // rad
  std::optional<double> delay_margin;        // s
  std::optional<double> gain_up, gain_down;  // factors, > 1 and < 1
  std::optional<double> crossover_hz;        // where the phase margin is
};

// Why a model has none: empty where it has one.
std::string WithoutLinearLoop(const ModelOptions& options);

class LinearLoop {
 public:
  // person: with the masses of the model (own_axes.h). plane: 0 for (x, theta), 1 for (y, phi).
  // options must have a loop.
  LinearLoop(const ModelOptions& options, const Body& person, const ParameterSet<double>& p,
             int plane);

  LoopAnswer Answer(Disturbance disturbance, double hz) const;
  // L at s = 2 pi j hz.
  std::complex<double> LoopGain(double hz) const;
  LoopNumbers Numbers() const;

 private:
  using Complex = std::complex<double>;
  using Matrix2c = Eigen::Matrix2cd;
  using Row = Eigen::Matrix<double, 2, 3>;  // force on the cart, torque; by e, v, w

  // (M s^2 - J(s)), with the ankles' late part or without.
  Matrix2c Impedance(const Complex& s, bool with_ankle) const;
  // Rates of the modes, 1/s: of [e, v, w], with what is late.
  std::vector<Complex> Modes() const;
  void FindMargins(LoopNumbers* numbers) const;

  int plane_;
  Eigen::Matrix2d mass_, inertia_;  // of the body; and with what acts as mass
  double mgl_ = 0.0;                // N m/rad, of the body that turns
  Row now_ = Row::Zero(), ankle_ = Row::Zero(), step_ = Row::Zero();
  double ankle_delay_ = 0.0, step_delay_ = 0.0;  // s
};

}  // namespace pushid
