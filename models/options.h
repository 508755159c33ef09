// models: the choices that turn the general equations into one particular model. Plain data.
#pragma once

#include <memory>
#include <vector>

#include "models/enum_names.h"
#include "models/model_rows.h"
#include "models/terms.h"

namespace pushid {

// What the balance error is measured from.
enum class Posture {
  kUpright,  // from the vertical (LDP)
  kInitial   // from the person's posture at frame 0, with the torque that holds it
};
constexpr EnumNames<Posture, 2> Names(Posture) {
  return {{{"upright", Posture::kUpright}, {"initial", Posture::kInitial}}};
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
  kSlide,     // the cart is free from the first newton on
  kThreshold  // the feet hold until the capture point leaves their support; then they step
              // (stance.h)
};
constexpr EnumNames<Stance, 2> Names(Stance) {
  return {{{"slide", Stance::kSlide}, {"threshold", Stance::kThreshold}}};
}

// Kd_x and Kd_y multiply the cart's acceleration: an algebraic loop, hence off by default.
enum class CartDerivative {
  kNone,
  kBackward  // (v_t - v_{t-1}) / dt, as LDP's code does
};
constexpr EnumNames<CartDerivative, 2> Names(CartDerivative) {
  return {{{"none", CartDerivative::kNone}, {"backward", CartDerivative::kBackward}}};
}

class ForceLaw;
struct InteractionNetwork;
struct LearnedTerms;

struct ModelOptions {
  Posture posture = Posture::kInitial;
  GainScaling gain_scaling = GainScaling::kBody;
  FrictionKind friction = FrictionKind::kIsotropic;
  PushUse push = PushUse::kAdded;
  PushTail push_tail = PushTail::kExponential;
  Stance stance = Stance::kSlide;
  CartDerivative cart_derivative = CartDerivative::kNone;
  InteractionTerms interaction;
  std::shared_ptr<const InteractionNetwork> interaction_network;  // of the network term
  // What is learned (learned_terms.h); null: nothing.
  std::shared_ptr<const LearnedTerms> learned;
  // A user's own laws (force_law.h). Their parameters take the slots from kFirstOwnParameter on, in
  // this order. AddForceLaw (ident/parameters/own_laws.h) adds one with its rows.
  std::vector<std::shared_ptr<const ForceLaw>> own_laws = {};
  ProcessNoiseTerms process_noise = {};
};

}  // namespace pushid
