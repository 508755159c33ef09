// ident: sections of a report about a fit as a whole, which need no recordings.
#pragma once

#include <string>

#include "ident/model/fitted_model.h"
#include "ident/report/document.h"

namespace pushid {

// A section with nothing to say is empty and left out.
ReportSection SummarySection(const FittedModel& model);
// Warnings: those of the fit, then findings about the recordings.
std::vector<std::string> WarningTexts(const FitResult& result);
ReportSection BehaviourSection(const FittedModel& model);
ReportSection LoopSection(const FittedModel& model);
ReportSection RecordingSection(const FittedModel& model);
ReportSection LeverageSection(const FittedModel& model);
ReportSection ResidualSection(const FittedModel& model);
ReportSection AdviceSection(const FittedModel& model);
ReportSection ProvenanceSection(const FittedModel& model);

}  // namespace pushid
