// models: the choices that turn the general equations into one particular model. Plain data.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "models/enum_names.h"
#include "models/model_rows.h"

namespace pushid {

// What people may do to each other, and the parts that the net force is made of. Every list
// of them - flags, CSV headers, pictures, totals - is made from tables: the rows of model_rows.h
// and those here.

// What people do to each other: terms that add up (interaction.h), and one for a learned force
// (learned_terms.h), which has a size besides its name (ident/parameters/fit_options.h).
struct InteractionTerms {
#define PUSHID_TERM(id, Law) bool id = false;
  PUSHID_PAIR_TERMS(PUSHID_TERM, PUSHID_TERM)
#undef PUSHID_TERM
  bool learned = false;
  bool learned_in_range = false;  // LDP's: of every neighbour, not of those who touch

  // Terms that depend on the distance of the points of contact, and terms that depend on that of
  // the carts.
#define PUSHID_TERM(id, Law) id ||
  bool Contact() const {
    return PUSHID_PAIR_TERMS(PUSHID_TERM, PUSHID_NO_PAIR_TERM)(learned && !learned_in_range);
  }
  bool AtCarts() const {
    return PUSHID_PAIR_TERMS(PUSHID_NO_PAIR_TERM, PUSHID_TERM)(learned && learned_in_range);
  }
#undef PUSHID_TERM
  bool Any() const { return Contact() || AtCarts(); }
  // What one gets the other gives: contact alone.
  bool Mutual() const { return Any() && !learned && !AtCarts(); }
};

struct InteractionTermName {
  std::string_view name;
  bool InteractionTerms::*member;
};
inline constexpr InteractionTermName kInteractionTerms[] = {
#define PUSHID_TERM(id, Law) {#id, &InteractionTerms::id},
    PUSHID_PAIR_TERMS(PUSHID_TERM, PUSHID_TERM)
#undef PUSHID_TERM
};

// White forces that act on everybody beside all others (process_noise.h).
enum class ProcessNoise {
  kNone,
  kDiagonal  // one standard deviation for each generalized force
};
constexpr EnumNames<ProcessNoise, 2> Names(ProcessNoise) {
  return {{{"none", ProcessNoise::kNone}, {"diagonal", ProcessNoise::kDiagonal}}};
}

// The parts of the net force, in the order of the CSV's columns. The last three are reported
// only where they act (ReportedParts).
#define PUSHID_FORCE_PARTS(X)                             \
  X(kFriction, "friction")       /* of the ground */      \
  X(kBalance, "balance")         /* PD control */         \
  X(kLinear, "linear")           /* cross terms */        \
  X(kPush, "push")               /* as recorded */        \
  X(kTail, "tail")               /* of a net push */      \
  X(kInteraction, "interaction") /* with others */        \
  X(kNetwork, "network")         /* learned self force */ \
  X(kNoise, "noise")             /* drawn */              \
  X(kOwn, "own")                 /* laws of the user's */ \
  X(kInertia, "inertia")         /* on ground that moves */

enum class ForcePart : int {
#define PUSHID_FORCE_PART(id, name) id,
  PUSHID_FORCE_PARTS(PUSHID_FORCE_PART)
#undef PUSHID_FORCE_PART
};

inline constexpr std::string_view kForcePartNames[] = {
#define PUSHID_FORCE_PART(id, name) name,
    PUSHID_FORCE_PARTS(PUSHID_FORCE_PART)
#undef PUSHID_FORCE_PART
};
inline constexpr int kNumForceParts = sizeof(kForcePartNames) / sizeof(kForcePartNames[0]);

// For loops over the parts.
inline constexpr auto kForceParts = [] {
  std::array<ForcePart, kNumForceParts> parts{};
  for (int i = 0; i < kNumForceParts; ++i) parts[i] = static_cast<ForcePart>(i);
  return parts;
}();

constexpr std::string_view NameOf(ForcePart part) {
  return kForcePartNames[static_cast<int>(part)];
}

// What the balance error is measured from.
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

// How the gains, quoted for the reference person, carry over to another body.
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

#define PUSHID_FRICTION(id, ...) id,
enum class FrictionKind { PUSHID_FRICTION_LAWS(PUSHID_FRICTION) };
#undef PUSHID_FRICTION
#define PUSHID_FRICTION(...) +1
constexpr EnumNames<FrictionKind, 0 PUSHID_FRICTION_LAWS(PUSHID_FRICTION)> Names(FrictionKind) {
#undef PUSHID_FRICTION
#define PUSHID_FRICTION(id, name, ...) {name, FrictionKind::id},
  return {{PUSHID_FRICTION_LAWS(PUSHID_FRICTION)}};
#undef PUSHID_FRICTION
}

// What happens to the other forces while a push lasts.
enum class PushUse {
  kAsRecorded,  // what the recording's push kind says
  kAdded        // the push is added to all other forces, whatever its kind
};
constexpr EnumNames<PushUse, 2> Names(PushUse) {
  return {{{"as_recorded", PushUse::kAsRecorded}, {"added", PushUse::kAdded}}};
}

// What a `net` push, which covers only its first part, does after its last published frame.
enum class PushTail { kNone, kExponential };
constexpr EnumNames<PushTail, 2> Names(PushTail) {
  return {{{"none", PushTail::kNone}, {"exponential", PushTail::kExponential}}};
}

// What the feet do.
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

// How late active feedback comes (reaction_delay.h).
enum class Delay {
  kNone,         // at once
  kOne,          // all of it after one reaction_delay
  kAnkleAndStep  // ankles after reaction_delay, feet after step_delay
};
constexpr EnumNames<Delay, 3> Names(Delay) {
  return {{{"none", Delay::kNone}, {"one", Delay::kOne}, {"ankle_and_step", Delay::kAnkleAndStep}}};
}

// Where a body's mass is (ipm.h).
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
  // What is learned (learned_terms.h); null: nothing.
  std::shared_ptr<const LearnedTerms> learned;
  // A user's own laws (force_law.h). Their parameters take the slots from kFirstOwnParameter on, in
  // this order. AddForceLaw (ident/parameters/parameter_table.h) adds one with its rows.
  std::vector<std::shared_ptr<const ForceLaw>> own_laws = {};
  ProcessNoise process_noise = ProcessNoise::kNone;
};

// What the filter of unknown forces takes people to be (input_filter.h).
struct InputNoise {
  double force_time = 0.1;      // s, in which an unknown force dies out
  double force = 4.0;           // its standard deviation over the mass, m/s^2
  double measured = 0.0012;     // standard deviation of measured places, m
  double measured_time = 0.13;  // s, in which an error of measurement dies out
};

}  // namespace pushid
