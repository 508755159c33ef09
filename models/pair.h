// models: two people who may act on each other: the interface of all interaction terms.
//
// A term is a struct with
//   template <typename T> static void Add(const Pair&, const ParameterSet<T>&,
//                                         const PendulumState<T>& n, const PendulumState<T>& j,
//                                         PairForce<T>*);
// that adds the generalized forces [N, N, N m, N m] it exerts on both. interaction.h sums the
// terms that a model asks for; a term whose force shall be a part of its own in reports has a
//   static constexpr ForcePart kPart
// from kFirstPairPart on (terms.h).
#pragma once

#include <cmath>

#include "models/dual.h"
#include "models/ipm.h"
#include "models/parameters.h"

namespace pushid {

// Two people and how they stood at frame 0.
struct Pair {
  Body body_n, body_j;
  Vector4<double> q0_n = Vector4<double>::Zero(), q0_j = Vector4<double>::Zero();

  Pair Swapped() const { return {body_j, body_n, q0_j, q0_n}; }
};

template <typename T>
struct PairForce {
  Vector4<T> on_n = Vector4<T>::Zero(), on_j = Vector4<T>::Zero();
  bool acts = false;
};

}  // namespace pushid
