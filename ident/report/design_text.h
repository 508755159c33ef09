// ident: which further push would tell most, as a table and in words.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "ident/validation/experiment_design.h"
#include "ident/validation/study_plan.h"

namespace pushid {

// The best `count` candidates for a parameter, or for all together ("all"), best first, and after a
// gap the least useful one. Errors: no such parameter.
Result<TextTable> DesignTable(const ExperimentDesign& design, const std::string& parameter,
                              int count);

// With a heading and the present error below it; then what a force sensor and more people would
// tell. Errors: no such parameter.
Result<std::string> DesignText(const ExperimentDesign& design, const std::string& parameter);

// What a force sensor and more people would tell, as tables and in words.

// Of one parameter, or of "all"; only a header where there is nothing to tell.
TextTable SensorTable(const StudyPlan& plan, const std::string& parameter);
TextTable StudySizesTable(const StudyPlan& plan, const std::string& parameter);

// Why there is none of them; empty where there is.
std::string NoSensorText(const StudyPlan& plan);
std::string NoSizesText(const StudyPlan& plan);

// Both with headings, or why there is none.
std::string StudiesText(const StudyPlan& plan, const std::string& parameter);

// What the table of sizes does not say: what the spread between people is and how well it is known.
std::string StudySizesNote(const StudyPlan& plan);

}  // namespace pushid
