// ident: what pushes that are not known exactly add to the errors of a fit.
//
// The fit was repeated with each variant of its pushes (push_variants.h). Sources of error are
// independent and add up; the variants of one source stand for what it may do:
//
//   push error^2  = sum over sources of the mean over its variants of (value - estimate)^2
//   total error^2 = standard error^2 + push error^2
//
// Moves are counted from the estimate, not from the variants' mean: a recipe that moves an estimate
// one way in all its variants has moved it all the same. Variants that failed are left out.
#pragma once

#include <vector>

#include "ident/uncertainty/refit_table.h"

namespace pushid {

struct PushError {
  double push = 0.0, total = 0.0;
};

// By parameter, natural units.
std::vector<PushError> PushErrors(const RefitTable& check);

}  // namespace pushid
