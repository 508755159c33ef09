// tests: random bodies, states and parameters for the model tests, seeded.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "models/ipm.h"
#include "models/parameters.h"
#include "models/self_force.h"

namespace pushid {

inline constexpr double kSampleDt = 1.0 / 60.0;  // s

inline Body RandomBody(Random* random) {
  return {random->Uniform(50, 110), random->Uniform(0.77, 1.08), random->Uniform(0.0, 0.12)};
}

inline Vector4<double> RandomVector(Random* random, double magnitude) {
  Vector4<double> v;
  for (int i = 0; i < 4; ++i) v[i] = random->Uniform(-magnitude, magnitude);
  return v;
}

// Positions and speeds a person may reach times `magnitude`; angles stay below 1.2 rad.
inline PendulumState<double> RandomState(Random* random, double magnitude = 1.0) {
  PendulumState<double> state{RandomVector(random, 2.0 * magnitude),
                              RandomVector(random, 3.0 * magnitude)};
  state.q.tail<2>() *= 0.6;
  return state;
}

// Every parameter away from zero, so that no term drops out of a comparison.
inline ParameterSet<double> RandomParameters(Random* random) {
  ParameterSet<double> p;
  for (double& value : p) value = random->Uniform(0.5, 3.0);
  return p;
}

// Element by element, relative to `scale` (at least) or the element itself.
template <typename A, typename B>
void ExpectClose(const A& actual, const B& expected, double tolerance, double scale = 1.0) {
  ASSERT_EQ(actual.rows(), expected.rows());
  ASSERT_EQ(actual.cols(), expected.cols());
  for (int i = 0; i < actual.rows(); ++i) {
    for (int j = 0; j < actual.cols(); ++j) {
      EXPECT_NEAR(actual(i, j), expected(i, j),
                  tolerance * std::max(scale, std::abs(expected(i, j))))
          << "row " << i << ", column " << j;
    }
  }
}

// All of a person's own force: friction, and what the person does.
template <typename T>
Vector4<T> OwnForce(const SelfForce& self, const ParameterSet<T>& p, const PendulumState<T>& state,
                    const Vector4<T>& qd_previous) {
  return self.Friction(p, state.qd) + self.Effort(p, state, qd_previous);
}

}  // namespace pushid
