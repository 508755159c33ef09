// residuals: from the blocks that Ceres moves to the parameters of each person.
//
// Parameter blocks of one recording, in this order:
//   0        shared values on the fitted scale, one entry per fitted parameter
//   1 .. S   deviations of each distinct unit - subject, setting or condition - one entry per
//   pooled parameter
//            (absent when none)
//   next     initial velocities [xd, yd, thetad, phid] per person, m/s and rad/s (only when free)
//   last     weights of what is learned, self force and rod (only when there is any)
// A person's value is natural(shared + deviation); with no deviation, natural(shared). Adding on
// the fitted scale makes a pooled positive parameter vary by factors and never change sign.
// Covariates add to it in the same way (Covariate); their slopes are among the shared values.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/parameters.h"

namespace pushid {

// Facts of people that shift their parameters.
//
// A person's parameter is natural(shared + deviation + sum of slope * x), with x the person's value
// of a covariate:
//   a number    age less the mean age of the people of the fit
//   a contrast  -1/2 where a label has one value, +1/2 where it has another
// Each slope is one more fitted number, in a parameter slot of its own (kNumOwnParameters). Of a
// positive parameter it is the logarithm of a ratio. x = 0, the mean person, where a value is not
// known, and where no particular person is meant (settling, behaviour).

// Numbers that are known of everybody, from the body: kg, m.
inline constexpr char kMassCovariate[] = "mass", kRodCovariate[] = "rod";

struct Covariate {
  std::string key;            // of a person's numbers, or of the label
  double centre = 0.0;        // of a number: where x is 0
  std::string first, second;  // the label's values: x is -1/2 and +1/2; empty: a number

  bool is_contrast() const { return !second.empty(); }
  bool operator==(const Covariate& other) const {
    return key == other.key && centre == other.centre && first == other.first &&
           second == other.second;
  }
};

// The effect of a slope: it moves `target`, and `also` what has the target's value.
struct CovariateShift {
  Parameter slope, target;
  Transform transform;  // of the target
  int covariate;        // in the map's list
  std::optional<Parameter> also = std::nullopt;
};

// The unit by which pooled parameters may differ, to which a deviation belongs: the
// person, or recordings of one label (datasets/manifest/recording.h): setting,
// condition, or any other key; the setting of a recording without the label.
inline constexpr char kSubjectUnit[] = "subject";
// Whether all people in a recording belong to one unit.
inline bool HoldsForRecording(const std::string& pool_by) { return pool_by != kSubjectUnit; }

struct FittedParameter {
  Parameter parameter;
  Transform transform;
  int deviation = -1;                            // index in a unit's block, -1 when not pooled
  std::optional<Parameter> also = std::nullopt;  // another that has the same value
};

// d (a person's parameter) / d (a column of the recording's Jacobian).
struct ColumnEntry {
  int column;
  Parameter parameter;
  double derivative;
};

struct ParameterMap {
  ParameterSet<double> values{};        // of the parameters that are not fitted
  std::vector<FittedParameter> fitted;  // in the order of the shared block
  int num_deviations = 0;               // length of a unit's block; 0: no such blocks
  std::string pool_by = kSubjectUnit;
  int num_weights = 0;  // of what is learned
  std::vector<Covariate> covariates;
  std::vector<CovariateShift> shifts;  // by every slope, fitted or held

  int num_shared() const { return static_cast<int>(fitted.size()); }

  // Moves a set without covariates to a person's, whose slots hold the slopes. x: a value for each
  // of the covariates.
  template <typename T>
  void Shift(const std::vector<double>& x, ParameterSet<T>* set) const {
    for (const CovariateShift& shift : shifts) {
      T& target = (*set)[shift.target];
      target = Shifted<T>(shift.transform, target, (*set)[shift.slope] * x[shift.covariate]);
      if (shift.also) (*set)[*shift.also] = target;
    }
  }

  // The parameter that the shared value of an index acts through: itself, or the target that a
  // slope moves, `by` so much of the target's fitted scale.
  struct Action {
    Parameter parameter;
    Transform transform;
    std::optional<Parameter> also;
    double by = 1.0;
  };
  // x may be null: a slope moves nothing then.
  Action ActionOf(size_t index, const std::vector<double>* x) const {
    const FittedParameter& f = fitted[index];
    for (const CovariateShift& shift : shifts) {
      if (shift.slope != f.parameter) continue;
      return {shift.target, shift.transform, shift.also,
              x != nullptr ? (*x)[shift.covariate] : 0.0};
    }
    return {f.parameter, f.transform, f.also};
  }

  // deviation may be null, and so may x, a person's value of each covariate: zero then.
  template <typename T>
  ParameterSet<T> Apply(const T* shared, const T* deviation,
                        const std::vector<double>* x = nullptr) const {
    ParameterSet<T> set;
    for (int i = 0; i < kNumParameters; ++i) set[i] = T(values[i]);
    for (size_t i = 0; i < fitted.size(); ++i) {
      T value = shared[i];
      if (deviation != nullptr && fitted[i].deviation >= 0) value += deviation[fitted[i].deviation];
      set[fitted[i].parameter] = ToNatural(fitted[i].transform, value);
      if (fitted[i].also) set[*fitted[i].also] = set[fitted[i].parameter];
    }
    if (x != nullptr) Shift(*x, &set);
    return set;
  }

  // Entries of one person by the shared block. x as that of Apply.
  std::vector<ColumnEntry> Entries(const ParameterSet<double>& set,
                                   const std::vector<double>* x = nullptr) const {
    std::vector<ColumnEntry> entries;
    for (size_t i = 0; i < fitted.size(); ++i) {
      const int column = static_cast<int>(i);
      const Action a = ActionOf(i, x);
      const double slope = a.by * TransformSlope(a.transform, set[a.parameter]);
      entries.push_back({column, a.parameter, slope});
      if (a.also) entries.push_back({column, *a.also, slope});
    }
    return entries;
  }
};

// How one recording's people hang on its parameter blocks.
//
// Derivatives are carried by acting columns, the fewest of which every column of the blocks is one
// or a sum: a parameter that units differ in has one for each unit, which is its deviation's, and
// the sum of them is the shared value's; any other parameter has one. Where all people share a
// unit, as in a pool by setting, that is half of the columns.
struct BlockLayout {
  std::vector<std::string> units;  // distinct, in order of first appearance
  std::vector<int> unit_of_person;
  bool free_initial_velocity = false;
  int num_shared = 0;
  int num_deviations = 0;
  int num_weights = 0;
  std::vector<int> first_acting;  // of each fitted parameter, then the end of the last
  std::vector<int> of_deviation;  // the fitted parameter of each
  // Values of each covariate for each person; empty: no particular people.
  std::vector<std::vector<double>> covariates;

  BlockLayout() = default;
  BlockLayout(const ParameterMap& map, const std::vector<std::string>& unit_of_each_person,
              bool free_velocity, std::vector<std::vector<double>> covariates_of_each_person = {});

  int num_people() const { return static_cast<int>(unit_of_person.size()); }
  std::vector<int> BlockSizes() const;
  int num_columns() const;  // of all blocks, side by side
  int num_acting() const;   // parameters, then velocities, then weights
  // First acting column of the initial velocities; negative when they are not fitted.
  int VelocityColumn() const;
  int WeightColumn() const;  // first acting column of learned weights
  // Entries of one person, by acting column.
  std::vector<ColumnEntry> Entries(const ParameterMap& map, const ParameterSet<double>& set,
                                   int person) const;
  // For each column of the blocks: first and last of the acting columns whose sum it is.
  std::vector<std::pair<int, int>> ActingOfColumns() const;

  // The parameters and initial velocities of every person, for any scalar.
  template <typename T>
  std::vector<ParameterSet<T>> Parameters(const ParameterMap& map, T const* const* blocks) const {
    std::vector<ParameterSet<T>> sets;
    for (size_t n = 0; n < unit_of_person.size(); ++n) {
      const T* const deviation = num_deviations > 0 ? blocks[1 + unit_of_person[n]] : nullptr;
      sets.push_back(map.Apply<T>(blocks[0], deviation, CovariatesOf(n)));
    }
    return sets;
  }
  // Covariates of a person; null without particular people.
  const std::vector<double>* CovariatesOf(size_t person) const {
    return covariates.empty() ? nullptr : &covariates[person];
  }
  // nullptr when the initial velocities are not fitted.
  template <typename T>
  const T* VelocityBlock(T const* const* blocks) const {
    return free_initial_velocity ? blocks[num_blocks() - (num_weights > 0 ? 2 : 1)] : nullptr;
  }
  // nullptr when there is no network.
  template <typename T>
  const T* WeightBlock(T const* const* blocks) const {
    return num_weights > 0 ? blocks[num_blocks() - 1] : nullptr;
  }
  int num_blocks() const {
    return 1 + (num_deviations > 0 ? static_cast<int>(units.size()) : 0) +
           (free_initial_velocity ? 1 : 0) + (num_weights > 0 ? 1 : 0);
  }
};

}  // namespace pushid
