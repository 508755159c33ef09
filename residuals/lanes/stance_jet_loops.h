// residuals: stance_jet.h for the file that includes this, as person_lanes_loops.h.
#pragma once

#include "models/stance.h"
#include "residuals/lanes/jet_scalar.h"
#include "residuals/lanes/stance_jet.h"

namespace pushid {
namespace {

constexpr int kMostColumns = 16, kLeastColumns = 8;  // that a jet has

// x m / (x^4 + m^4)^(1/4), whose factors as jets take five times as long.
template <int kColumns>
VectorJet<kColumns> Limited(const VectorJet<kColumns>& x, const VectorJet<kColumns>& most) {
  const double x2 = x.a * x.a, most2 = most.a * most.a, x4 = x2 * x2, most4 = most2 * most2;
  const double sum = x4 + most4, inverse = 1.0 / __builtin_sqrt(__builtin_sqrt(sum));
  const double slope = inverse / sum;
  return VectorJet<kColumns>::Sum(x.a * most.a * inverse, most.a * most4 * slope, x,
                                  x.a * x4 * slope, most);
}

}  // namespace

template <>
inline VectorJet<kMostColumns> SmoothLimit(const VectorJet<kMostColumns>& x,
                                           const VectorJet<kMostColumns>& most) {
  return Limited(x, most);
}
template <>
inline VectorJet<kLeastColumns> SmoothLimit(const VectorJet<kLeastColumns>& x,
                                            const VectorJet<kLeastColumns>& most) {
  return Limited(x, most);
}

namespace {

// Of the columns from `first` on.
template <int kColumns>
void StanceJetOf(const StanceJetInputs& in, std::ptrdiff_t first, double* of_forces,
                 double* of_feet) {
  using T = VectorJet<kColumns>;
  const auto input = [&](double value, const double* rows, int row) {
    return T(value, rows + row * in.columns + first);
  };
  FeetState<T> feet;
  for (int i = 0; i < 2; ++i) feet.apart[i] = input(in.feet[i], in.by_feet, i);
  feet.clock = input(in.feet[2], in.by_feet, 2);
  feet.swing_time = input(in.feet[3], in.by_feet, 3);
  feet.swings = in.swings;
  feet.landed = in.landed;
  feet.fresh = in.fresh;
  const auto hip = [&](const PerceivedHip& felt, const double* rows) {
    const T theta = input(0.0, rows, 0), phi = input(0.0, rows, 1);
    Angles<T> angles;
    angles.s_th = T::Scaled(felt.s_th, felt.c_th, theta);
    angles.c_th = T::Scaled(felt.c_th, -felt.s_th, theta);
    angles.s_ph = T::Scaled(felt.s_ph, felt.c_ph, phi);
    angles.c_ph = T::Scaled(felt.c_ph, -felt.s_ph, phi);
    Vector4<T> qd;
    for (int i = 0; i < 4; ++i) qd[i] = input(felt.qd[i], rows, 2 + i);
    return HipOverFeet<T>(in.body, angles, qd);
  };
  const HipOverFeet<T> ankle = hip(in.ankle, in.by_ankle);
  const HipOverFeet<T> step = in.by_step != nullptr ? hip(in.step, in.by_step) : ankle;
  int next = 0;  // in the order of the members, which is that of kIds
  const StanceParameters<T> p([&](Parameter) {
    const int row = next++;
    return input(in.parameters[row], in.by_parameter, row);
  });
  const StanceForces<T> out = StanceStep<T>(in.body, p, feet, ankle, step.Capture(in.body)).Run();
  const T* const forces[] = {&out.velocity[0], &out.velocity[1], &out.torque[0], &out.torque[1]};
  const T* const after[] = {&out.next.apart[0], &out.next.apart[1], &out.next.clock,
                            &out.next.swing_time};
  for (int i = 0; i < 4; ++i) {
    forces[i]->StoreSlopes(of_forces + i * in.columns + first);
    after[i]->StoreSlopes(of_feet + i * in.columns + first);
  }
}

void StanceJet(const StanceJetInputs& in, double* of_forces, double* of_feet) {
  std::ptrdiff_t first = 0;
  for (; first + kMostColumns <= in.columns; first += kMostColumns) {
    StanceJetOf<kMostColumns>(in, first, of_forces, of_feet);
  }
  if (first < in.columns) StanceJetOf<kLeastColumns>(in, first, of_forces, of_feet);
}

}  // namespace
}  // namespace pushid
