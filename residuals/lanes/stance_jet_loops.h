// residuals: stance_jet.h for the file that includes this, as person_lanes_loops.h.
#pragma once

#include "models/stance.h"
#include "residuals/lanes/jet_scalar.h"
#include "residuals/lanes/stance_jet.h"

namespace pushid {
namespace {

template <bool kLate>
void StanceJetOf(const StanceJetInputs& in, double* by_input) {
  constexpr int kInputs = StanceJetSize(kLate);
  using T = VectorJet<kInputs>;
  int at = 0;
  const auto input = [&at](double value) { return T(value, at++); };
  FeetState<T> feet;
  for (int i = 0; i < 2; ++i) feet.apart[i] = input(in.feet[i]);
  feet.clock = input(in.feet[2]);
  feet.swing_time = input(in.feet[3]);
  feet.swings = in.swings;
  feet.landed = in.landed;
  feet.fresh = in.fresh;
  const auto hip = [&](const PerceivedHip& felt) {
    Angles<T> angles;
    angles.s_th = T(felt.s_th, at, felt.c_th), angles.c_th = T(felt.c_th, at, -felt.s_th);
    ++at;
    angles.s_ph = T(felt.s_ph, at, felt.c_ph), angles.c_ph = T(felt.c_ph, at, -felt.s_ph);
    ++at;
    Vector4<T> qd;
    for (int i = 0; i < 4; ++i) qd[i] = input(felt.qd[i]);
    return HipOverFeet<T>(in.body, angles, qd);
  };
  const HipOverFeet<T> ankle = hip(in.ankle);
  const Horizontal<T> xi = (kLate ? hip(in.step) : ankle).Capture(in.body);
  const double* next = in.parameters;  // in the order of the members, which is that of kIds
  const StanceParameters<T> p([&](Parameter) { return input(*next++); });
  const StanceForces<T> out = StanceStep<T>(in.body, p, feet, ankle, xi).Run();
  const T* const outputs[kStanceOutputs] = {
      &out.velocity[0],   &out.velocity[1],   &out.torque[0],  &out.torque[1],
      &out.next.apart[0], &out.next.apart[1], &out.next.clock, &out.next.swing_time};
  for (int i = 0; i < kInputs; ++i) {
    for (int k = 0; k < kStanceOutputs; ++k)
      by_input[kStanceOutputs * i + k] = outputs[k]->Slope(i);
  }
}

void StanceJet(const StanceJetInputs& in, double* by_input) {
  if (in.late) {
    StanceJetOf<true>(in, by_input);
  } else {
    StanceJetOf<false>(in, by_input);
  }
}

}  // namespace
}  // namespace pushid
