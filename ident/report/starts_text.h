// ident: what the starts of a multi-start agree on.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/results/fit_result.h"

namespace pushid {

// Starts whose cost is within this of the best one share its basin, or one as good.
inline constexpr double kSameCost = 0.01;  // relative

// How many starts ended as well as the best one, and over which range their parameters spread
// beside the best one's standard errors; empty for a single start.
std::string AcrossStartsText(const FitResult& result);

// The same in parts: a sentence, and a table (only a header when none is as good).
std::string AcrossStartsNote(const FitResult& result);
TextTable AcrossStartsTable(const FitResult& result);

}  // namespace pushid
