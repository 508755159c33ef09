// models: the physical parameters of one person, by name. A parameter set is a plain array indexed
// by Parameter, so that it can be instantiated for doubles and for automatic differentiation alike.
// Their facts - units, defaults, what they act on - are in parameter_facts.h.
#pragma once

#include <array>
#include <string_view>

#include "models/model_rows.h"

namespace pushid {

// Slots for the parameters of a user's own force laws (force_law.h), after those with a row.
inline constexpr int kNumOwnParameters = 6;

enum Parameter : int {
#define PUSHID_PARAMETER(id, ...) id,
  PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
      kFirstOwnParameter,
  kNumParameters = kFirstOwnParameter + kNumOwnParameters
};

// What two people share: the parameters of the terms between them.
inline constexpr int kFirstPairParameter = kContactStiffness;
inline constexpr int kNumPairParameters = kRodLift - kContactStiffness;
constexpr bool IsPairParameter(Parameter id) {
  return id >= kFirstPairParameter && id < kFirstPairParameter + kNumPairParameters;
}

// What process noise has: its factor, and what is measured.
inline constexpr int kFirstNoiseParameter = kSigmaX, kLastNoiseParameter = kMeasuredHip;
constexpr bool IsNoiseParameter(Parameter id) {
  return id >= kFirstNoiseParameter && id <= kLastNoiseParameter;
}
constexpr bool IsMeasurementError(Parameter id) {
  return id == kMeasuredCart || id == kMeasuredHip;
}

// Of those with a row.
inline constexpr std::array<std::string_view, kFirstOwnParameter> kParameterNames = {
#define PUSHID_PARAMETER(id, name, ...) name,
    PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
};

template <typename T>
using ParameterSet = std::array<T, kNumParameters>;

}  // namespace pushid
