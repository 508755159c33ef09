// ident: sections of a report about the parameters, which need no recordings.
#pragma once

#include <map>
#include <string>

#include "datasets/files/error.h"
#include "ident/model/fitted_model.h"
#include "ident/report/document.h"

namespace pushid {

// A section with nothing to say is empty and left out.
ReportSection ParameterSection(const FittedModel& model);
ReportSection ContrastSection(const FittedModel& model);  // "By group: patients less controls"
ReportSection UnitSection(const FittedModel& model);      // "By subject"
ReportSection IdentifiabilitySection(const FittedModel& model);
// Intervals by profiles and by a bootstrap, and the estimates from fewer frames (pushid-check).
ReportSection ProfileSection(const FittedModel& model);

// The values of the free parameters with all their intervals; known: only of those identified.
ReportFigure IntervalFigure(const FittedModel& model, bool known);

// The true parameters, by name, that a manifest of pushid-simulate holds under `synthetic`.
// Errors: unreadable, or a manifest of real recordings.
Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path);
// truth | identified | 95 % interval | whether it covers the truth, for every fitted parameter.
std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth);

}  // namespace pushid
