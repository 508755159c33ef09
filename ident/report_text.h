// ident: a fit's result in words and tables for a terminal: a pure function of the result.
#pragma once

#include <string>

#include "ident/crossvalidation.h"
#include "ident/fit_result.h"

namespace pushid {

// The parameter table, what is derived, what the data cannot tell apart, what the fitted person
// does after a push, warnings.
std::string ReportText(const FitResult& result);

std::string EvaluationText(const Evaluation& evaluation, bool per_recording);
std::string CrossValidationText(const std::vector<CrossValidation>& rivals);

// "0.341", "1.86e+03": four significant digits.
std::string Significant(double value, int digits = 4);

}  // namespace pushid
