// residuals: what is known of people and shifts their parameters.
//
// A person's parameter is natural(shared + deviation + sum of slope * x), with x the person's value
// of a covariate:
//   a number    age less the mean age of the people of the fit
//   a contrast  -1/2 where a label has one value, +1/2 where it has another
// Each slope is one more fitted number, in a parameter slot of its own (kNumOwnParameters). Of a
// positive parameter it is the logarithm of a ratio. x = 0, the mean person, where a value is not
// known, and where no particular person is meant (settling, behaviour).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/parameters.h"

namespace pushid {

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

// What a slope does: it moves `target`, and `also` what has the target's value.
struct CovariateShift {
  Parameter slope, target;
  Transform transform;  // of the target
  int covariate;        // in the map's list
  std::optional<Parameter> also = std::nullopt;
};

}  // namespace pushid
