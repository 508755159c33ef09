// ident: a fit's result in words and tables for a terminal: a pure function of the result.
#pragma once

#include <map>
#include <string>

#include "ident/model/fitted_model.h"

namespace pushid {

// The parameter table, what is derived, what the data cannot tell apart, what the fitted person
// does after a push, warnings.
std::string ReportText(const FittedModel& model);

// What is learned on top of the physics, and what it acts like; no line break at the end, and empty
// where nothing is.
std::string NetworkText(const FitResult& result);

// -2 log likelihood, AIC, BIC and what they may be compared with; result.likelihood must be there.
std::string LikelihoodText(const FitResult& result);

// What was done to recordings before the fit, as the report says it.

// "motion: low-pass at 6 Hz (zero-phase Butterworth), resampled to 60 frames per second" with a
// newline, from the flags that a result keeps; empty where the motion was taken as recorded. A
// replica of a bootstrap says so on a line of its own.
std::string PreparationText(const std::map<std::string, std::string>& configuration);

// Identified values beside the truth of synthetic recordings.

// The true parameters, by name, that a manifest of pushid-simulate holds under `synthetic`.
// Errors: unreadable, or a manifest of real recordings.
Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path);

// truth | identified | 95 % interval | whether it covers the truth, for every fitted parameter.
std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth);

}  // namespace pushid
