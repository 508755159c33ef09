// ident: identified values beside the truth of synthetic recordings.
#pragma once

#include <map>
#include <string>

#include "ident/results/fit_result.h"

namespace pushid {

// The true parameters, by name, that a manifest of pushid-simulate holds under `synthetic`.
// Errors: unreadable, or a manifest of real recordings.
Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path);

// truth | identified | 95 % interval | whether it covers the truth, for every fitted parameter.
std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth);

}  // namespace pushid
