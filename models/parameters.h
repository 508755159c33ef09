// models: the physical parameters of one person, by name. A parameter set is a plain array indexed
// by Parameter, so that it can be instantiated for doubles and for automatic differentiation alike.
// And their facts: units, defaults, what they act on, all from the rows of model_rows.h.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "models/enum_names.h"
#include "models/model_rows.h"
#include "models/options.h"

namespace pushid {

// Slots after those with a row: for the parameters of a user's own force laws (force_law.h), then
// for the slopes by which covariates shift other parameters (residuals/parameter_map.h).
inline constexpr int kNumOwnParameters = 16;

enum Parameter : int {
#define PUSHID_PARAMETER(id, ...) id,
  PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
      kFirstOwnParameter,
  kNumParameters = kFirstOwnParameter + kNumOwnParameters
};

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

// Names of the parameters with a row.
inline constexpr std::array<std::string_view, kFirstOwnParameter> kParameterNames = {
#define PUSHID_PARAMETER(id, name, ...) name,
    PUSHID_PARAMETERS(PUSHID_PARAMETER)
#undef PUSHID_PARAMETER
};

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

// Facts of a parameter before any fit (model_rows.h).

// Also how a user's own force law describes its parameters (force_law.h).
struct ParameterFacts {
  std::string_view name;
  std::string_view symbol;
  std::string_view unit;
  double nominal = 0.0;  // start of a fit, value when fixed
  double lower = 0.0, upper = 0.0;
  double scale = 1.0;  // a typical size, for scaling null directions and judging "weak"
  Transform transform = Transform::kIdentity;
  std::string_view meaning = {};       // one line for people
  std::string_view when_to_free = {};  // another
};

// The reason why a row is unfit for a fit, as in "must start within its bounds"; empty: nothing.
std::string Violation(const ParameterFacts& facts);

// In the order of Parameter.
const std::array<ParameterFacts, kFirstOwnParameter>& AllParameterFacts();

// Whether a parameter has any effect in a model; one of a user's own where some law claims it.
bool Acts(Parameter id, const ModelOptions& model);

// Whether choosing a term that the model has frees the parameter.
bool FreedByItsTerm(Parameter id, const ModelOptions& model);

}  // namespace pushid
