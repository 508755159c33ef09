// models: the physical parameters of one person, by name. A parameter set is a plain array indexed
// by Parameter, so that it can be instantiated for doubles and for automatic differentiation alike.
// Their facts stand in one table: units, defaults, and where they act.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "models/enum_names.h"
#include "models/options.h"

namespace pushid {

// Slots after those with a row: for the parameters of a user's own force laws (force_law.h), then
// for the slopes by which covariates shift other parameters (residuals/parameter_map.h).
inline constexpr int kNumOwnParameters = 16;

// Parameters of one term stand together: friction from kMu up to kKpX, contact from
// kContactStiffness to kContactHeight, all that two people share from there up to kSupportFront.
// clang-format off
enum Parameter : int {
  kMu, kMuY, kCoulombFriction, kKpX, kKpY, kKpTheta, kKpPhi, kKdX, kKdY, kKdTheta, kKdPhi,
  kReactionDelay, kStepDelay, kPassiveStiffness, kPassiveDamping,
  kCartMassShare, kGyrationRadius, kPushGain,
  kAx, kAy, kBx, kBy, kTx, kTy, kCq, kDq,
  kTailGain, kTailTorque, kTailTime, kTailExponent, kTailBase,
  kContactStiffness, kContactDistance, kContactKappa, kContactDamping, kContactHeight,
  kPotentialStrength, kPotentialLength, kNeighbourRange, kLeanTheta, kLeanPhi,
  kSupportFront, kSupportBack, kSupportSide, kFootFront, kStepGain, kStepOnset, kStepSwing,
  kComHeight,
  kSigmaX, kSigmaY, kSigmaTheta, kSigmaPhi, kMeasuredCart, kMeasuredHip,
  kFirstOwnParameter,
  kNumParameters = kFirstOwnParameter + kNumOwnParameters
};
// clang-format on

// Parameters that two people share: those of the terms between them.
inline constexpr int kFirstPairParameter = kContactStiffness;
inline constexpr int kNumPairParameters = kSupportFront - kContactStiffness;
constexpr bool IsPairParameter(Parameter id) {
  return id >= kFirstPairParameter && id < kFirstPairParameter + kNumPairParameters;
}

// Parameters of process noise: its factor, and errors of measurement.
inline constexpr int kFirstNoiseParameter = kSigmaX, kLastNoiseParameter = kMeasuredHip;
constexpr bool IsNoiseParameter(Parameter id) {
  return id >= kFirstNoiseParameter && id <= kLastNoiseParameter;
}
constexpr bool IsMeasurementError(Parameter id) {
  return id == kMeasuredCart || id == kMeasuredHip;
}

template <typename T>
using ParameterSet = std::array<T, kNumParameters>;

// The scale on which a parameter is fitted.
enum class Transform {
  kIdentity,
  kLog,   // positive parameters
  kLogit  // unit interval
};
constexpr EnumNames<Transform, 3> Names(Transform) {
  return {
      {{"identity", Transform::kIdentity}, {"log", Transform::kLog}, {"logit", Transform::kLogit}}};
}

template <typename T>
T ToNatural(Transform transform, const T& fitted) {
  using std::exp;
  switch (transform) {
    case Transform::kLog:
      return exp(fitted);
    case Transform::kLogit:
      return 1.0 / (1.0 + exp(-fitted));
    case Transform::kIdentity:
      break;
  }
  return fitted;
}

inline double ToFitted(Transform transform, double natural) {
  if (transform == Transform::kLog) return std::log(natural);
  if (transform == Transform::kLogit) return std::log(natural / (1.0 - natural));
  return natural;
}

// A natural value after a step on the fitted scale; without its logarithm, which may not exist.
template <typename T>
T Shifted(Transform transform, const T& natural, const T& by) {
  using std::exp;
  switch (transform) {
    case Transform::kLog:
      return natural * exp(by);
    case Transform::kLogit: {
      const T odds = natural * exp(by);
      return odds / (odds + 1.0 - natural);
    }
    case Transform::kIdentity:
      break;
  }
  return natural + by;
}

// d natural / d fitted, at a natural value.
inline double TransformSlope(Transform transform, double natural) {
  if (transform == Transform::kLog) return natural;
  if (transform == Transform::kLogit) return natural * (1.0 - natural);
  return 1.0;
}

// Facts of a parameter before any fit. Also how a user's own force law describes its parameters
// (force_law.h).
struct ParameterFacts {
  std::string_view name;    // on the command line and in files
  std::string_view symbol;  // in the equation that heads the file of its term
  std::string_view unit;
  double nominal = 0.0;  // start of a fit, value when fixed: where its term vanishes, or LDP's
  double lower = 0.0, upper = 0.0;  // bounds of a fit
  double scale = 1.0;  // a typical size, for scaling null directions and judging "weak"
  Transform transform = Transform::kIdentity;
  std::string_view meaning = {};       // one line for people
  std::string_view when_to_free = {};  // another
};

struct ParameterRow {
  Parameter value;
  bool (*acts)(const ModelOptions&);  // whether the parameter has any effect in a model
  ParameterFacts facts;
  bool (*freed)(const ModelOptions&) = nullptr;  // whether its term frees it, with a weak prior
};

// The row of every parameter, and the names of its columns.
namespace parameter_rows {

constexpr Transform kIdentity = Transform::kIdentity, kLog = Transform::kLog,
                    kLogit = Transform::kLogit;
inline bool Always(const ModelOptions&) { return true; }
inline bool Slides(const ModelOptions& m) { return m.stance == Stance::kSlide; }
inline bool DragsSideways(const ModelOptions& m) {
  return Slides(m) && m.friction == FrictionKind::kAnisotropic;
}
inline bool IsDry(const ModelOptions& m) { return m.friction == FrictionKind::kCoulomb; }
inline bool DragsDry(const ModelOptions& m) { return Slides(m) && IsDry(m); }
inline bool SeesAcceleration(const ModelOptions& m) {
  return m.cart_derivative == CartDerivative::kBackward;
}
inline bool IsLate(const ModelOptions& m) { return m.delay != Delay::kNone; }
inline bool FeetAreLate(const ModelOptions& m) {
  return m.delay == Delay::kAnkleAndStep && m.stance != Stance::kFixed;
}
inline bool IsRig(const ModelOptions& m) { return m.body == BodyModel::kTable; }
inline bool IsRigThatSlides(const ModelOptions& m) { return IsRig(m) && Slides(m); }
inline bool TailSlides(const ModelOptions& m) { return HasTail(m) && Slides(m); }
inline bool Springs(const ModelOptions& m) { return m.interaction.spring; }
inline bool Damps(const ModelOptions& m) { return m.interaction.damping; }
inline bool Touches(const ModelOptions& m) { return m.interaction.Contact(); }
inline bool IsLdps(const ModelOptions& m) { return m.interaction.ldp_published; }
inline bool ActsAtCarts(const ModelOptions& m) { return m.interaction.AtCarts(); }
inline bool Steps(const ModelOptions& m) { return m.stance == Stance::kSteps; }
inline bool HasComHeight(const ModelOptions& m) { return IsRig(m) || m.stance == Stance::kFixed; }
inline bool IsNoisy(const ModelOptions& m) { return m.process_noise != ProcessNoise::kNone; }

// Gains are quoted for the reference person (85 kg, rod 0.95 m); see GainScaleOf in self_terms.h.
// clang-format off
inline constexpr ParameterRow kRows[] = {
  // friction and balance: the cart's gains may turn negative, the data must be able to say so
  {kMu, Slides, {"mu", "mu", "N s/m", 100, -2000, 2000, 100, kIdentity,
   "drag of the stepping feet (not floor friction)",
   "always: with Kp_x and Kp_y held it is the whole drag of the stepping feet"}},
  {kMuY, DragsSideways, {"mu_y", "mu_y", "N s/m", 100, -2000, 2000, 100, kIdentity,
   "drag of the stepping feet along y", "with pushes to the side, and anisotropic friction"}},
  {kCoulombFriction, DragsDry, {"mu_coulomb", "mu_c", "1", 0.02, 0, 5, 0.05, kIdentity,
   "dry friction of the cart over its weight",
   "with --friction=coulomb: rigs and robots whose cart comes to a stop"}, IsDry},
  {kKpX, Slides, {"Kp_x", "Kp_x", "N s/m", 0, -2000, 2000, 100, kIdentity,
   "balance gain on the cart's velocity, x",
   "never together with mu: only mu + Kp_x is identifiable"}},
  {kKpY, Slides, {"Kp_y", "Kp_y", "N s/m", 0, -2000, 2000, 100, kIdentity,
   "balance gain on the cart's velocity, y",
   "never together with mu or mu_y: only the sum is identifiable"}},
  {kKpTheta, Always, {"Kp_theta", "Kp_theta", "N m/rad", 1500, 1, 1e5, 1500, kLog,
   "balance stiffness about y", "always, with pushes forwards or backwards"}},
  {kKpPhi, Always, {"Kp_phi", "Kp_phi", "N m/rad", 1500, 1, 1e5, 1500, kLog,
   "balance stiffness about x", "with pushes to the side"}},
  {kKdX, SeesAcceleration, {"Kd_x", "Kd_x", "kg", 0, -500, 500, 10, kIdentity,
   "balance gain on the cart's acceleration, x",
   "to compare with LDP's code; it is an algebraic loop"}},
  {kKdY, SeesAcceleration, {"Kd_y", "Kd_y", "kg", 0, -500, 500, 10, kIdentity,
   "balance gain on the cart's acceleration, y",
   "to compare with LDP's code; it is an algebraic loop"}},
  {kKdTheta, Always, {"Kd_theta", "Kd_theta", "N m s/rad", 70, 1e-3, 1e4, 70, kLog,
   "balance damping about y", "where the angular rates are well measured"}},
  {kKdPhi, Always, {"Kd_phi", "Kd_phi", "N m s/rad", 70, 1e-3, 1e4, 70, kLog,
   "balance damping about x", "with pushes to the side and well measured rates"}},
  // how late active feedback comes, and what muscles do at once (reaction_delay.h)
  {kReactionDelay, IsLate, {"reaction_delay", "d", "s", 0.13, 0.005, 0.6, 0.05, kLog,
   "reaction delay of active feedback",
   "with --delay: people answer after 0.1 to 0.2 s, and without it damping comes out too low"},
   IsLate},
  {kStepDelay, FeetAreLate, {"step_delay", "d_s", "s", 0.2, 0.005, 0.8, 0.05, kLog,
   "reaction delay of the feet", "with --delay=ankle_and_step"}, FeetAreLate},
  {kPassiveStiffness, IsLate, {"passive_stiffness", "s_K", "1", 0.2, 0.005, 0.99, 0.2, kLogit,
   "share of the stiffness that acts at once",
   "with --delay: muscles and tendons do not wait"}, IsLate},
  {kPassiveDamping, IsLate, {"passive_damping", "s_D", "1", 0.2, 0.005, 0.99, 0.2, kLogit,
   "share of the damping that acts at once",
   "with --delay: muscles and tendons do not wait"}, IsLate},
  // the body and its drive, of robots and rigs (ipm.h)
  {kCartMassShare, IsRigThatSlides, {"cart_share", "s_c", "1", 0.1, 0.001, 0.98, 0.1, kLogit,
   "share of the mass that is in the cart", "with --body=table, where it is not known"}},
  {kGyrationRadius, IsRigThatSlides, {"gyration_radius", "r", "1", 0, 0, 3, 0.3, kIdentity,
   "radius of gyration about the centre of mass over the rod",
   "with --body=table, where it is not known"}},
  {kPushGain, IsRig, {"push_gain", "g_u", "1", 1, 0.01, 100, 1, kLog,
   "force of a push over what was recorded of it",
   "with --body=table, where a motor's force is known up to a factor"}},
  // the linear self force
  {kAx, Slides, {"a_x", "a_x", "m/s^2/rad", 0, -200, 200, 10, kIdentity,
   "cart force from the lean, x", "where the feet follow the lean, as they do after most pushes"}},
  {kAy, Slides, {"a_y", "a_y", "m/s^2/rad", 0, -200, 200, 10, kIdentity,
   "cart force from the lean, y", "with pushes to the side"}},
  {kBx, Slides, {"b_x", "b_x", "m/s/rad", 0, -50, 50, 2, kIdentity,
   "cart force from the lean's rate, x",
   "with many recordings: only fast motion separates it from a_x"}},
  {kBy, Slides, {"b_y", "b_y", "m/s/rad", 0, -50, 50, 2, kIdentity,
   "cart force from the lean's rate, y", "with many pushes to the side"}},
  {kTx, Slides, {"t_x", "t_x", "m/s", 0, -50, 50, 2, kIdentity,
   "torque from the cart's velocity, x", "where the lean goes on while the cart runs"}},
  {kTy, Slides, {"t_y", "t_y", "m/s", 0, -50, 50, 2, kIdentity,
   "torque from the cart's velocity, y", "with many pushes to the side"}},
  {kCq, Slides, {"c_q", "c_q", "1/m", 0, -20, 20, 0.5, kIdentity,
   "quadratic damping of the cart", "with pushes of very different strength"}},
  {kDq, Slides, {"d_q", "d_q", "1/rad", 0, -50, 50, 1, kIdentity,
   "quadratic damping of the angles", "with pushes of very different strength"}},
  // the push tail
  {kTailGain, HasTail, {"tail_gain", "g", "1", 1, 1e-3, 50, 1, kLog,
   "ratio of tail force to mean push force", "where the pushes cover only their first part"}},
  {kTailTorque, TailSlides, {"tail_torque", "r", "1", 0.3, -50, 50, 0.3, kIdentity,
   "ratio of tail torque to mean push torque", "where the pushes cover only their first part"}},
  {kTailTime, HasTail, {"tail_time", "t", "s", 0.2, 0.005, 5, 0.2, kLog,
   "tail's decay time after a push of 0.1 s", "where the pushes cover only their first part"}},
  {kTailExponent, HasTail, {"tail_exponent", "e", "1", 0, -5, 5, 1, kIdentity,
   "growth of that time with the push's duration", "with pushes of different duration"}},
  {kTailBase, HasTail, {"tail_base", "b", "m/s", 0, -5, 5, 0.5, kIdentity,
   "speed from the tail's part that does not depend on the push",
   "with pushes of different strength that cover only their first part"}},
  // between people: contact first, in one piece
  {kContactStiffness, Springs, {"contact_stiffness", "A", "N/m", 2000, 1, 1e5, 2000, kLog,
   "stiffness of contact between people", "where people touch"}, Springs},
  {kContactDistance, Touches, {"contact_distance", "d_contact", "m", 0.4, 0.05, 1.5, 0.4, kLog,
   "distance at which people touch", "where people touch"}, Touches},
  {kContactKappa, Touches, {"contact_kappa", "kappa", "1", 0.6, 0.01, 10, 0.6, kLog,
   "weight of the sideways distance", "where people stand side by side as well"}, Touches},
  {kContactDamping, Damps, {"contact_damping", "B", "N s/m", 100, 1e-3, 1e4, 100, kLog,
   "damping of contact", "where people touch"}, Damps},
  {kContactHeight, Touches, {"contact_height", "s", "1", 0.5, 0.01, 1.6, 0.5, kIdentity,
   "height of contact over the ankles, in lengths of the rod (1: the hip)",
   "with many groups that touch, whose check says so"}},
  {kPotentialStrength, IsLdps, {"potential_strength", "u", "N m", 150, 0.1, 1e5, 150, kLog,
   "strength of LDP's potential", "to compare with LDP"}},
  {kPotentialLength, IsLdps, {"potential_length", "sigma", "m", 0.5, 0.02, 5, 0.5, kLog,
   "decay length of LDP's potential", "to compare with LDP"}},
  {kNeighbourRange, ActsAtCarts, {"neighbour_range", "range", "m", 0.5, 0.1, 3, 0.5, kLog,
   "cart distance at which LDP's terms end", "where people stand farther apart than half a metre"}},
  {kLeanTheta, IsLdps, {"lean_theta", "k_theta", "N m", 100, -2000, 2000, 100, kIdentity,
   "torque against leaning on others, y", "to compare with LDP"}},
  {kLeanPhi, IsLdps, {"lean_phi", "k_phi", "N m", 50, -2000, 2000, 100, kIdentity,
   "torque against leaning on others, x", "to compare with LDP"}},
  // feet that stand and step (stance.h)
  {kSupportFront, Steps, {"support_front", "b", "m", 0.1, 0.01, 0.5, 0.1, kLog,
   "how far before the ankles the capture point goes before a step is due",
   "with pushes forwards, some of which make people step and some not"}},
  {kSupportBack, Steps, {"support_back", "b_back", "m", 0.06, 0.01, 0.5, 0.06, kLog,
   "how far behind the ankles the capture point goes before a step is due",
   "with pushes backwards, some of which make people step and some not"}},
  {kSupportSide, Steps, {"support_side", "b_side", "m", 0.1, 0.01, 0.5, 0.1, kLog,
   "how far beside an ankle the capture point goes before a step is due",
   "with pushes to the side, some of which make people step and some not"}},
  {kFootFront, Steps, {"foot_front", "f", "m", 0.2, 0.02, 0.5, 0.1, kLog,
   "how far before the ankles the centre of pressure reaches",
   "never without force plates: few recorded people reach the limit"}},
  {kStepGain, Steps, {"step_gain", "kappa", "1", 0.9, 0.05, 5, 1, kLog,
   "length of a step over the way of the capture point at landing",
   "with recordings long enough to show where the feet end"}},
  {kStepOnset, Steps, {"step_onset", "t_on", "s", 0.5, 0.005, 2, 0.2, kLog,
   "how long a step is prepared just beyond the edge of the support", "where feet hold and step"}},
  {kStepSwing, Steps, {"step_swing", "t_s", "s", 0.32, 0.05, 2, 0.2, kLog,
   "how long the foot of a first step is in the air", "where feet hold and step"}},
  // feet that hold, whatever happens (standing.h)
  {kComHeight, HasComHeight, {"com_height", "k", "1", 1.09, 0.1, 2, 0.1, kLog,
   "height of the body's centre of mass above the ankles over the hip's",
   "with known pushes on people who stand: it tells where their mass is"}},
  // process noise, and the noise of what is measured (process_noise.h); freed by a likelihood
  {kSigmaX, IsNoisy, {"sigma_x", "sigma_x", "N s^0.5", 20, 1e-4, 1e5, 20, kLog,
   "white force along x", "with --likelihood=transition or innovation"}},
  {kSigmaY, IsNoisy, {"sigma_y", "sigma_y", "N s^0.5", 20, 1e-4, 1e5, 20, kLog,
   "white force along y", "with --likelihood=transition or innovation"}},
  {kSigmaTheta, IsNoisy, {"sigma_theta", "sigma_theta", "N m s^0.5", 15, 1e-4, 1e5, 15, kLog,
   "white torque about y", "with --likelihood=transition or innovation"}},
  {kSigmaPhi, IsNoisy, {"sigma_phi", "sigma_phi", "N m s^0.5", 15, 1e-4, 1e5, 15, kLog,
   "white torque about x", "with --likelihood=transition or innovation"}},
  {kMeasuredCart, IsNoisy, {"measured_cart", "s_c", "m", 0.003, 1e-4, 1, 0.003, kLog,
   "error of the measured cart on each axis", "with --likelihood=innovation"}},
  {kMeasuredHip, IsNoisy, {"measured_hip", "s_h", "m", 0.003, 1e-4, 1, 0.003, kLog,
   "error of the measured hip on each axis", "with --likelihood=innovation"}},
};
// clang-format on
static_assert(std::size(kRows) == kFirstOwnParameter && RowsAreInOrder(kRows),
              "a row is found by its parameter");

}  // namespace parameter_rows
inline constexpr const auto& kParameterRows = parameter_rows::kRows;

// Names of the parameters with a row.
inline constexpr auto kParameterNames = [] {
  std::array<std::string_view, kFirstOwnParameter> names{};
  for (const ParameterRow& row : kParameterRows) names[row.value] = row.facts.name;
  return names;
}();

// The reason why a row is unfit for a fit, as in "must start within its bounds"; empty: nothing.
std::string Violation(const ParameterFacts& facts);

// Whether a parameter has any effect in a model; one of a user's own where some law claims it.
bool Acts(Parameter id, const ModelOptions& model);

// Whether choosing a term that the model has frees the parameter.
bool FreedByItsTerm(Parameter id, const ModelOptions& model);

}  // namespace pushid
