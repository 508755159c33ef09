// ident: how values and intervals are said, in tables and sentences alike.
#pragma once

#include <string>

#include "ident/model/fitted_model.h"

namespace pushid {

// The end of a 95 % interval as it is shown: one that tells nothing (of a positive value a factor
// of more than 100 away, or with an interval over four orders of magnitude) is infinite.
double ShownEnd(double value, double end, double other_end);
// "[20, 42]", "[20, open]"; "undetermined" where both ends are open.
std::string IntervalText(double value, double lower, double upper);

// The gains in words: "ankle stiffness 1.6 times m g l (1 just holds a pendulum upright)".
std::string GainsText(const FitResult& result);

}  // namespace pushid
