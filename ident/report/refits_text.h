// ident: what other pushes and shorter horizons make of the estimates, as tables and in words.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/uncertainty/refit_checks.h"

namespace pushid {

// Parameter, value, standard error, push error and total error (push/push_check.h).
TextTable PushErrorTable(const RefitTable& check);

// A row for each refit: by how much it moves every parameter.
TextTable MovesTable(const RefitTable& check);

// Parameter by horizon, value +- standard error; and a sentence for each drift.
TextTable HorizonTable(const RefitTable& check);
std::string DriftText(const RefitTable& check);

// Parameter, value, and what it is under each other prior.
TextTable PriorTable(const RefitTable& check);

// For a terminal, with headings.
std::string PushCheckText(const RefitTable& check);
std::string HorizonCheckText(const RefitTable& check);
// Which claim belongs to which horizon; empty where single steps were not fitted.
std::string HorizonClaims(const RefitTable& check);
std::string PriorCheckText(const RefitTable& check);

}  // namespace pushid
