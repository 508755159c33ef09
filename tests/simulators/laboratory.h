// Recordings as a laboratory has them, of people of a model other than the fitted one.
//
//   LaboratoryOptions options;
//   MaybeError failed = WriteLaboratoryStudy("lab", options);  // lab/manifest.json, lab/truth.json
//
// A person is a double inverted pendulum in the sagittal plane: legs on the ankles, head, arms and
// trunk on the hips, with the masses and lengths of Winter (Biomechanics and Motor Control of Human
// Movement, 4th ed., table 4.1). With absolute angles a (legs) and b (trunk), and ankles at x:
//
//   (m1 c1^2 + I1 + m2 l^2) a'' + m2 l c2 cos(a - b) b''
//       = (m1 c1 + m2 l)(g sin a - x'' cos a) + T - H + F l cos a - m2 l c2 sin(a - b) b'^2
//   m2 l c2 cos(a - b) a'' + (m2 c2^2 + I2) b''
//       = m2 c2 (g sin b - x'' cos b) + H + m2 l c2 sin(a - b) a'^2
//
// T at the ankles and H at the hips are stiffness and damping, passive ones at once and active ones
// after `delay` seconds, with a tonic torque that holds a small lean forward, and slow noise at the
// ankles (sway). T cannot move the centre of pressure out of the standing feet. When the
// extrapolated centre of mass (Hof, J. Biomech. 38, 2005) has been outside the feet for a reaction
// time, the hind foot steps to its future place (minimum jerk); x is the middle of the two ankles.
//
// The integrator is Runge-Kutta of fourth order at half a millisecond. No code of models/ is used,
// because these people test it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/random.h"

namespace pushid {

struct LaboratoryPerson {
  double mass_kg = 75.0, height_m = 1.75;
  // Gains of ankles or hips: N m/rad and N m s/rad.
  struct Joint {
    double active = 0.0, passive = 0.0, active_damping = 0.0, passive_damping = 0.0;
  };
  Joint ankle, hip;
  double delay_s = 0.12;  // of active torques
  double lean_rad = 0.0;  // of the legs at rest

  double RodLength() const { return 0.491 * height_m; }  // from ankles to hips, m
};

// A pull at the hips: half a sine.
struct LaboratoryPush {
  double start_s = 0.5, duration_s = 0.3;
  double peak_N = 0.0;  // backwards: negative
  double ForceAt(double t) const;
};

// The state at one time; x forward, z up.
struct LaboratorySample {
  double legs = 0.0, trunk = 0.0;                          // rad
  double foot[2] = {}, foot_lift[2] = {};                  // left and right ankle, m; from standing
  double shear_N = 0.0, vertical_N = 0.0, centre_m = 0.0;  // of both feet on the ground
  double push_N = 0.0;
};
struct LaboratoryStep {
  int foot = 0;  // 0: left
  double lift_off_s = 0.0, landing_s = 0.0, length_m = 0.0;
};
struct LaboratoryTrial {
  std::vector<LaboratorySample> samples;  // kLaboratoryHz
  std::vector<LaboratoryStep> steps;
};
inline constexpr int kLaboratoryHz = 1000;

struct LaboratoryOptions {
  int people = 4;
  int standing = 6, stepping = 2;  // pulls of each person that are withstood, and that take steps
  double seconds = 3.0;
  uint64_t seed = 1;
};

// The study's people: common gains, with a spread of 5 %.
std::vector<LaboratoryPerson> DrawLaboratoryPeople(const LaboratoryOptions& options);

// sway: N m, standard deviation of the slow noise; half: steps of a quarter of a millisecond.
// Errors: the person falls.
Result<LaboratoryTrial> SimulateLaboratoryTrial(const LaboratoryPerson& person,
                                                const LaboratoryPush& push, double seconds,
                                                double sway, uint64_t seed, int substeps = 2);

// TRC files of markers (100 Hz, mm, y up), tables of two force platforms and of the load cell
// (1 kHz, with noise and an offset), manifest.json, and the truth in truth.json: gains of the
// reference person (as pushid quotes them), gains of all people, and the steps.
MaybeError WriteLaboratoryStudy(const std::string& folder, const LaboratoryOptions& options);

}  // namespace pushid
