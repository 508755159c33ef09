// ident: a fit's result in words and tables for a terminal: a pure function of the result.
#pragma once

#include <string>

#include "ident/results/fitted_model.h"

namespace pushid {

// The parameter table, what is derived, what the data cannot tell apart, what the fitted person
// does after a push, warnings.
std::string ReportText(const FittedModel& model);

// What is learned on top of the physics, and what it acts like; no line break at the end, and empty
// where nothing is.
std::string NetworkText(const FitResult& result);

// -2 log likelihood, AIC, BIC and what they may be compared with; result.likelihood must be there.
std::string LikelihoodText(const FitResult& result);

}  // namespace pushid
