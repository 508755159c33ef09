// ident: -2 log likelihood of a fit by single steps, and what is made of it.
#pragma once

#include <algorithm>
#include <cmath>

namespace pushid {

// How well a fit by a likelihood explains the recordings, to compare with other models by the same
// likelihood of the same recordings.
struct LikelihoodScore {
  double deviance = 0.0;  // -2 log likelihood
  int measured = 0;       // numbers
  int parameters = 0;     // free ones, units' deviations not counted

  double Aic() const { return deviance + 2.0 * parameters; }
  double Bic() const {
    return deviance + std::log(static_cast<double>(std::max(1, measured))) * parameters;
  }
};
}  // namespace pushid
