// models: two people who may act on each other: the interface of all interaction terms.
//
// A term is a struct with
//   template <typename T> static void Add(const Pair&, const ParameterSet<T>&,
//                                         const PosedPendulum<T>& n, const PosedPendulum<T>& j,
//                                         PairForce<T>*);
// that adds the generalized forces [N, N, N m, N m] it exerts on both. interaction.h sums the
// terms that a model asks for.
#pragma once

#include "models/dual.h"
#include "models/ipm.h"
#include "models/parameters.h"

namespace pushid {

// How a person stood at frame 0.
struct FirstPose {
  Vector4<double> q = Vector4<double>::Zero();
  Angles<double> angles;

  FirstPose() = default;
  explicit FirstPose(const Vector4<double>& at) : q(at), angles(at) {}
};

// Two people and how they stood at frame 0.
struct Pair {
  Body body_n, body_j;
  FirstPose first_n, first_j;

  Pair Swapped() const { return {body_j, body_n, first_j, first_n}; }
};

template <typename T>
struct PairForce {
  Vector4<T> on_n = Vector4<T>::Zero(), on_j = Vector4<T>::Zero();
  bool acts = false;
};

}  // namespace pushid
