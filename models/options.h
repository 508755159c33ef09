// models: the choices that turn the general equations into one particular model. Plain data.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "models/enum_names.h"

namespace pushid {

// The terms between people, which add up (interaction.h), and one for a learned force
// (learned_terms.h), which has a size besides its name (ident/parameters/fit_options.h).
struct InteractionTerms {
  bool spring = false, damping = false;  // of contact
  bool ldp_published = false;
  bool learned = false;
  bool learned_in_range = false;  // LDP's: from all neighbours in range, also without contact

  // Terms that depend on the distance of the points of contact, and terms that depend on that of
  // the carts.
  bool Contact() const { return spring || damping || (learned && !learned_in_range); }
  bool AtCarts() const { return ldp_published || (learned && learned_in_range); }
  bool Any() const { return Contact() || AtCarts(); }
  // Whether forces between two people are equal and opposite, as those of contact are.
  bool Mutual() const { return Any() && !learned && !AtCarts(); }
};

// The terms that --interaction names. Every list of them is made from this table.
struct InteractionTermName {
  std::string_view name;
  bool InteractionTerms::*member;
};
inline constexpr InteractionTermName kInteractionTerms[] = {
    {"spring", &InteractionTerms::spring},
    {"damping", &InteractionTerms::damping},
    {"ldp_published", &InteractionTerms::ldp_published}};

// White forces on all people in addition to the modelled ones (process_noise.h).
enum class ProcessNoise {
  kNone,
  kDiagonal  // one standard deviation for each generalized force
};
constexpr EnumNames<ProcessNoise, 2> Names(ProcessNoise) {
  return {{{"none", ProcessNoise::kNone}, {"diagonal", ProcessNoise::kDiagonal}}};
}

// The parts of the net force, in the order of the CSV's columns. The last three are reported
// only where they act (ReportedParts). Every list of them - headers, pictures, totals - is made
// from the table of their names.
enum class ForcePart : int {
  kFriction,     // of the ground
  kBalance,      // PD control
  kLinear,       // cross terms
  kPush,         // as recorded
  kTail,         // of a net push
  kInteraction,  // with others
  kNetwork,      // learned self force
  kNoise,        // drawn
  kOwn,          // laws of the user's
  kInertia       // on ground that moves
};
inline constexpr int kNumForceParts = 10;
inline constexpr EnumNames<ForcePart, kNumForceParts> kForceParts = {
    {{"friction", ForcePart::kFriction},
     {"balance", ForcePart::kBalance},
     {"linear", ForcePart::kLinear},
     {"push", ForcePart::kPush},
     {"tail", ForcePart::kTail},
     {"interaction", ForcePart::kInteraction},
     {"network", ForcePart::kNetwork},
     {"noise", ForcePart::kNoise},
     {"own", ForcePart::kOwn},
     {"inertia", ForcePart::kInertia}}};
static_assert(RowsAreInOrder(kForceParts));
constexpr const auto& Names(ForcePart) { return kForceParts; }

// The posture from which the balance error is measured.
enum class Posture {
  kUpright,  // from the vertical (LDP)
  kInitial   // from the person's posture at frame 0, with the torque that holds it
};
constexpr EnumNames<Posture, 2> Names(Posture) {
  return {{{"upright", Posture::kUpright}, {"initial", Posture::kInitial}}};
}

// The axes in which a fit sees people, and whether they answer alike in all directions.
enum class Directions {
  kIsotropic,  // along the push on one person, what several face; sideways is as forwards
  kBody,       // along what people face; sideways parameters are their own
  kAxes        // those of the file; sideways parameters are their own
};
constexpr EnumNames<Directions, 3> Names(Directions) {
  return {{{"isotropic", Directions::kIsotropic},
           {"body", Directions::kBody},
           {"axes", Directions::kAxes}}};
}

// The scaling of gains, which are those of the reference person, to another body.
enum class GainScaling {
  kNone,  // the same newtons for everybody
  kMass,  // times M / 85 kg (LDP's data have one mass scale)
  kBody   // forces times M / 85 kg, stiffness also times l / 0.95 m, angular damping times its
          // square
};
constexpr EnumNames<GainScaling, 3> Names(GainScaling) {
  return {
      {{"none", GainScaling::kNone}, {"mass", GainScaling::kMass}, {"body", GainScaling::kBody}}};
}

// The law of the drag of a cart that slides (self_terms.h).
enum class FrictionKind {
  kIsotropic,    // one mu
  kAnisotropic,  // one for each axis
  kCoulomb       // mu and dry friction
};
constexpr EnumNames<FrictionKind, 3> Names(FrictionKind) {
  return {{{"isotropic", FrictionKind::kIsotropic},
           {"anisotropic", FrictionKind::kAnisotropic},
           {"coulomb", FrictionKind::kCoulomb}}};
}

// Treatment of the other forces while a push lasts.
enum class PushUse {
  kAsRecorded,  // what the recording's push kind says
  kAdded        // the push is added to all other forces, whatever its kind
};
constexpr EnumNames<PushUse, 2> Names(PushUse) {
  return {{{"as_recorded", PushUse::kAsRecorded}, {"added", PushUse::kAdded}}};
}

// The force after the last published frame of a `net` push, which covers only its first part.
enum class PushTail { kNone, kExponential };
constexpr EnumNames<PushTail, 2> Names(PushTail) {
  return {{{"none", PushTail::kNone}, {"exponential", PushTail::kExponential}}};
}

// The motion of the feet.
enum class Stance {
  kSlide,  // the cart is free from the first newton on
  kSteps,  // the feet hold; one of them steps once the capture point has left their support
           // (stance.h)
  kFixed   // the feet hold, whatever happens (standing.h)
};
constexpr EnumNames<Stance, 3> Names(Stance) {
  return {{{"slide", Stance::kSlide}, {"steps", Stance::kSteps}, {"fixed", Stance::kFixed}}};
}

// Kd_x and Kd_y multiply the cart's acceleration: an algebraic loop, hence off by default.
enum class CartDerivative {
  kNone,
  kBackward  // (v_t - v_{t-1}) / dt, as LDP's code does
};
constexpr EnumNames<CartDerivative, 2> Names(CartDerivative) {
  return {{{"none", CartDerivative::kNone}, {"backward", CartDerivative::kBackward}}};
}

// The delay of active feedback (reaction_delay.h).
enum class Delay {
  kNone,         // at once
  kOne,          // all of it after one reaction_delay
  kAnkleAndStep  // ankles after reaction_delay, feet after step_delay
};
constexpr EnumNames<Delay, 3> Names(Delay) {
  return {{{"none", Delay::kNone}, {"one", Delay::kOne}, {"ankle_and_step", Delay::kAnkleAndStep}}};
}

// The distribution of a body's mass (ipm.h).
enum class BodyModel {
  kLdp,             // nine tenths at the hip; of who stands, that of an average body (standing.h)
  kAnthropometric,  // where the recorded segments have it (de Leva 1996)
  kTable            // cart_share and gyration_radius of the table, for robots and rigs
};
constexpr EnumNames<BodyModel, 3> Names(BodyModel) {
  return {{{"ldp", BodyModel::kLdp},
           {"anthropometric", BodyModel::kAnthropometric},
           {"table", BodyModel::kTable}}};
}

class ForceLaw;
struct LearnedTerms;

struct ModelOptions {
  Posture posture = Posture::kInitial;
  GainScaling gain_scaling = GainScaling::kBody;
  Directions directions = Directions::kAxes;
  FrictionKind friction = FrictionKind::kIsotropic;
  PushUse push = PushUse::kAdded;
  PushTail push_tail = PushTail::kExponential;
  Stance stance = Stance::kSlide;
  Delay delay = Delay::kNone;
  BodyModel body = BodyModel::kLdp;
  CartDerivative cart_derivative = CartDerivative::kNone;
  InteractionTerms interaction;
  // Learned terms (learned_terms.h); null: none.
  std::shared_ptr<const LearnedTerms> learned;
  // A user's own laws (force_law.h). Their parameters take the slots from kFirstOwnParameter on, in
  // this order. AddForceLaw (ident/parameters/parameter_table.h) adds one with its rows.
  std::vector<std::shared_ptr<const ForceLaw>> own_laws = {};
  ProcessNoise process_noise = ProcessNoise::kNone;
};

inline bool HasTail(const ModelOptions& options) {
  return options.push_tail == PushTail::kExponential && options.stance != Stance::kFixed;
}

// Assumptions of the filter of unknown forces (input_filter.h).
struct InputNoise {
  double force_time = 0.1;      // s, in which an unknown force dies out
  double force = 4.0;           // its standard deviation over the mass, m/s^2
  double measured = 0.0012;     // standard deviation of measured places, m
  double measured_time = 0.13;  // s, in which an error of measurement dies out
};

}  // namespace pushid
