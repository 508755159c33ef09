// ident: the part of a fit that predictions need, as data.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/problem/behaviour.h"

namespace pushid {

struct ValueRange {
  double lower = std::numeric_limits<double>::infinity(), upper = 0.0;

  bool empty() const { return lower > upper; }
  void Add(double value) {
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  // The factor by which a value lies outside; 1 inside, and if the range is empty.
  double Beyond(double value) const {
    return empty() ? 1.0 : std::max({1.0, value / upper, lower / value});
  }
};

// A person of the fitted recordings, facing x: the body of the first, the usual lean at frame 0.
struct FittedPerson {
  double mass = 0.0, rod = 0.0, cart_height = 0.0;  // kg, m
  double theta = 0.0, phi = 0.0;                    // rad
  Eigen::Vector2d apart = Eigen::Vector2d::Zero();  // the left foot from the right one, m
};

// A push as they usually were in the fitted recordings: medians over those of the commonest kind.
struct UsualPush {
  PushKind kind = PushKind::kExternal;
  double duration = 0.2;  // of the rows, s
  double height = 1.0;    // of their torques over the rod: 1 is the hip
  double impulse = 80.0;  // N s
};

// The pushes and people that a model was fitted to (model/model_rollout.h). Whatever was not there
// is empty.
struct PushRange {
  ValueRange external_s, net_s;  // durations of the rows, s
  ValueRange impulse_per_mass;   // m/s
  ValueRange height;             // of external pushes, as a fraction of the rod
  ValueRange spacing;            // from everybody's cart to the nearest other one, m
  std::vector<FittedPerson> people;
  std::optional<UsualPush> usual;
  ValueRange direction;  // angles between pushes and the model's x axis, degrees

  ValueRange& Durations(PushKind kind) { return kind == PushKind::kExternal ? external_s : net_s; }
  const ValueRange& Durations(PushKind kind) const {
    return const_cast<PushRange*>(this)->Durations(kind);
  }
};

// How probable it is that a pushed person steps (fit/step_probability.h).
struct StepProbability {
  // a, and 1 / w in 1/m.
  Eigen::Vector2d coefficients = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  int tracks = 0, stepped = 0, clusters = 0;

  double At(double margin) const;
  double ErrorAt(double margin) const;
};

// The forecasters of a motion that was seen to begin (observed/first_frames.h): both together, or
// one alone.
enum class ForecastUse { kBoth, kPhysics, kInput };
constexpr EnumNames<ForecastUse, 3> Names(ForecastUse) {
  return {{{"both", ForecastUse::kBoth},
           {"physics", ForecastUse::kPhysics},
           {"input", ForecastUse::kInput}}};
}

// Shares at which quantiles of |error| over its scale are kept.
inline constexpr double kErrorShares[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5,
                                          0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 0.99};

// How far hips are from a forecast (observed/first_frames.h), on one axis.
struct ErrorScale {
  Eigen::Vector4d coefficients{-2.3, 1.0, 0.0, 0.3};  // of log m
  std::vector<double> quantiles;  // of |error| over that scale; empty: as of a normal distribution
};

// How forecasts are put together (observed/first_frames.h).
struct ForecastRule {
  double tail = 1.0;                 // of the filter: how much stronger and longer than the model's
  double input_time = 0.15;          // T, s
  std::array<ErrorScale, 3> errors;  // along the push, across, upwards
  // Forecasts that all this was learned from were made by models fitted without them: how many
  // such models, and of how many recordings. No folds: the model itself was all there was.
  int folds = 0, recordings = 0;
};

// Facts that a fit shares with the model that it gives.
struct ModelFacts {
  // Values as they act, fixed ones too. Indexed by Parameter.
  ParameterSet<double> parameters{};
  std::optional<PushRange> push_range;              // that it was fitted to; none without a fit
  std::optional<StepProbability> step_probability;  // none where nobody stepped or everybody did
  std::optional<ForecastRule> forecasts;            // from first frames; learned where asked
  Behaviour behaviour;                              // whether its people settle
};

struct FitResult;

// The model a prediction needs: options and parameters of each subject.
struct IdentifiedModel : ModelFacts {
  std::string source;  // file, for messages
  ModelOptions options;
  ParameterTable table;  // names, units and bounds, for --set
  std::string pool_by = kSubjectUnit;
  std::map<std::string, ParameterSet<double>> by_unit;  // options' pool_by; only where pooled

  // A unit the model does not know gets the shared values.
  const ParameterSet<double>& For(const std::string& unit) const {
    const auto found = by_unit.find(unit);
    return found == by_unit.end() ? parameters : found->second;
  }
};

IdentifiedModel ModelOf(const FitResult& result);

// A model with some values replaced, for what-ifs (--set).
MaybeError SetValues(const std::string& assignments, IdentifiedModel* model);

}  // namespace pushid
