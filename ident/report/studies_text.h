// ident: what a force sensor and more people would tell, as tables and in words.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/validation/study_plan.h"

namespace pushid {

// Of one parameter, or of "all"; only a header where there is nothing to tell.
TextTable SensorTable(const StudyPlan& plan, const std::string& parameter);
TextTable StudySizesTable(const StudyPlan& plan, const std::string& parameter);

// Both with headings, or why there is none.
std::string StudiesText(const StudyPlan& plan, const std::string& parameter);

// What the table of sizes does not say: what the spread between people is and how well it is known.
std::string StudySizesNote(const StudyPlan& plan);

}  // namespace pushid
