// ident: the sections of a report, each a pure function of the result and, where motion is shown,
// of the recordings seen through it (build_report.h). A section with nothing to say is empty.
#pragma once

#include <vector>

#include "ident/model/fitted_model.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/document.h"
#include "ident/validation/experiment_design.h"

namespace pushid {

// Charts side by side, unless a section says otherwise.
inline constexpr int kPanelColumns = 3;
inline constexpr double kPanelWidth = 320, kPanelHeight = 200;

ReportSection LeadSection(const FittedModel& model, const PropagationSummary& propagation);
ReportSection SummarySection(const FittedModel& model);
ReportSection ParameterSection(const FittedModel& model);
ReportSection UnitSection(const FittedModel& model);  // subjects or settings that differ
ReportSection IdentifiabilitySection(const FittedModel& model);
ReportSection ProfileSection(const FittedModel& model);
ReportSection BootstrapSection(const FittedModel& model);
ReportSection PushCheckSection(const FittedModel& model);
ReportSection HorizonCheckSection(const FittedModel& model);
ReportSection PriorCheckSection(const FittedModel& model);
ReportSection BehaviourSection(const FittedModel& model);
ReportSection PopulationSection(const FittedModel& model);
ReportSection VisualCheckSection(const FittedModel& model, const std::vector<RecordingView>& views);
ReportSection RecordingSection(const FittedModel& model);
ReportSection LeverageSection(const FittedModel& model);
ReportSection ResidualSection(const FittedModel& model);
ReportSection SolveSection(const FittedModel& model);
ReportSection MotionSection(const std::vector<RecordingView>& views);
ReportSection StepSection(const FittedModel& model, const std::vector<RecordingView>& views);
ReportSection GroupSection(const std::vector<RecordingView>& views,
                           const PropagationSummary& propagation);
ReportSection FigureSection(const std::vector<RecordingView>& views);
ReportSection DesignSection(const ExperimentDesign& design);
ReportSection AdviceSection(const FittedModel& model);
ReportSection ProvenanceSection(const FittedModel& model);

}  // namespace pushid
