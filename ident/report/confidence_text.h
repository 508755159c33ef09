// ident: profiles, bootstrap and diagnostics in words and tables for a terminal.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/results/fitted_model.h"

namespace pushid {

// Clustered, profile and bootstrap intervals side by side (only a header when neither was asked
// for), and whether they agree.
TextTable AgreementTable(const FittedModel& model);
std::string AgreementNote(const FittedModel& model);

// "resampling 4 people: 199 of 199 replicas, seed 1", and what to think of so few.
std::string ResamplingText(const Bootstrap& bootstrap);

// What was noted before the solve, the recordings that fit worst or move most, whether residuals
// are white, and what to try next.
std::string DiagnosticsText(const FittedModel& model);

}  // namespace pushid
