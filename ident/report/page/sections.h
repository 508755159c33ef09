// ident: the sections of a report, each a pure function of the result and, where motion is shown,
// of the recordings seen through it (recording_view.h). A section with nothing to say is empty.
#pragma once

#include <vector>

#include "ident/report/page/document.h"
#include "ident/report/page/recording_view.h"
#include "ident/validation/experiment_design.h"

namespace pushid {

ReportSection SummarySection(const FitResult& result);
ReportSection ParameterSection(const FitResult& result);
ReportSection UnitSection(const FitResult& result);  // subjects or settings that differ
ReportSection IdentifiabilitySection(const FitResult& result);
ReportSection ProfileSection(const FitResult& result);
ReportSection BootstrapSection(const FitResult& result);
ReportSection BehaviourSection(const FitResult& result);
ReportSection RecordingSection(const FitResult& result);
ReportSection LeverageSection(const FitResult& result);
ReportSection ResidualSection(const FitResult& result);
ReportSection SolveSection(const FitResult& result);
ReportSection MotionSection(const std::vector<RecordingView>& views);
ReportSection FigureSection(const std::vector<RecordingView>& views);
ReportSection DesignSection(const ExperimentDesign& design);
ReportSection ProvenanceSection(const FitResult& result);

}  // namespace pushid
