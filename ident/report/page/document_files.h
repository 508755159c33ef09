// ident: a report for a terminal, and the numbers behind its figures as CSV files.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/report/page/document.h"

namespace pushid {

// All sentences and tables; of a figure its caption and the name of its file of numbers.
std::string ToText(const Report& report);

// Rows of a table; fields with a comma or a quote are quoted.
std::string CsvOf(const TextTable& table);

// One file <name>.csv for each figure, in a folder that is made where it is missing.
MaybeError WriteNumbers(const Report& report, const std::string& folder);

}  // namespace pushid
