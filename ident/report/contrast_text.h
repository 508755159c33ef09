// ident: the difference between two values of a label, as a table and in words. Pure functions of
// the result.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// Only a header without a contrast.
TextTable ContrastTable(const Contrast& contrast);

// Who is compared with whom, whether effects are told in standard deviations, and what Holm's
// correction says: a line each.
std::string ContrastText(const FitResult& result);

}  // namespace pushid
