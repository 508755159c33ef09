// ident: profiles, bootstrap and diagnostics in words and tables for a terminal.
#pragma once

#include <string>

#include "ident/fit_result.h"

namespace pushid {

// Clustered, profile and bootstrap intervals side by side; empty when neither was asked for.
std::string AgreementText(const FitResult& result);

// What was noted before the solve, the recordings that fit worst or move most, whether residuals
// are white, and what to try next.
std::string DiagnosticsText(const FitResult& result);

}  // namespace pushid
