// ident: which further push would tell most, as a table and in words.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "ident/validation/experiment_design.h"

namespace pushid {

// The best `count` candidates for a parameter, or for all together ("all"), best first, and after a
// gap the least useful one. Errors: no such parameter.
Result<TextTable> DesignTable(const ExperimentDesign& design, const std::string& parameter,
                              int count);

// With a heading and the present error below it; then what a force sensor and more people would
// tell. Errors: no such parameter.
Result<std::string> DesignText(const ExperimentDesign& design, const std::string& parameter);

}  // namespace pushid
