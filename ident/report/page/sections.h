// ident: the sections of a report: a row each. A section with nothing to say stays empty and is
// left out. A new one is a renderer in a file of its own, its name and its row here.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/bodies/animation.h"
#include "ident/prediction/frequency_response.h"
#include "ident/report/page/build_report.h"

namespace pushid {

// What sections are made of.
struct ReportSource {
  const FittedModel& model;
  const FitResult& fit = model.fit;
  std::vector<RecordingView> views = {};  // of the recordings that are shown; may be none
  PropagationSummary propagation = {};    // of those
  // Of the recordings that are shown, on the ground that moves.
  std::vector<FrequencyResponse> frequency = {};
};

using RenderSection = ReportSection(const ReportSource& source);

struct SectionRow {
  const char* id;
  const char* title;  // where the section gives itself none
  RenderSection* render;
};

RenderSection LeadSection, SummarySection, ParameterSection, ContrastSection, UnitSection,
    IdentifiabilitySection, ProfileSection, BootstrapSection, HorizonCheckSection, BehaviourSection,
    LoopSection, FrequencySection, StepSection, GroupSection, FigureSection, MotionSection,
    RecordingSection, LeverageSection, ResidualSection, SolveSection, DesignSection, AdviceSection,
    ProvenanceSection;

// In the order of the report.
inline constexpr SectionRow kSections[] = {
    {"short", "In short", LeadSection},
    {"summary", "What was fitted", SummarySection},
    {"parameters", "Parameters", ParameterSection},
    {"contrast", "", ContrastSection},  // "By group: patients less controls"
    {"units", "", UnitSection},         // "By subject"
    {"identifiability", "Identifiability", IdentifiabilitySection},
    {"profiles", "Profile likelihood", ProfileSection},
    {"bootstrap", "Bootstrap", BootstrapSection},
    {"horizon_check", "Estimates from fewer frames", HorizonCheckSection},
    {"behaviour", "After a push", BehaviourSection},
    {"loop", "The identified loop", LoopSection},
    {"frequency", "Frequency response", FrequencySection},
    {"steps", "Who steps", StepSection},
    {"groups", "Groups", GroupSection},
    {"figure", "Moving figure", FigureSection},
    {"motion", "Measured and predicted motion", MotionSection},
    {"recordings", "Recording by recording", RecordingSection},
    {"leverage", "Influence of each recording", LeverageSection},
    {"residuals", "Residuals", ResidualSection},
    {"solve", "Solver convergence", SolveSection},
    {"design", "What to record next", DesignSection},
    {"advice", "What to try next", AdviceSection},
    {"provenance", "Provenance", ProvenanceSection},
};

// A value with its intervals, one above the other, and what it is compared with (an upright line),
// on a scale of its own. Interval ends that tell nothing are infinite.
struct IntervalRow {
  std::string name, unit;
  double value = 0.0, nominal = 0.0;
  std::vector<std::pair<Interval, std::string>> intervals;  // with their looks
};
Chart IntervalStrip(const IntervalRow& row);
inline constexpr char kIntervalLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
inline constexpr char kToldLook[] = "fill:none;stroke-width:3;stroke:#d55e00";

// The parameters' values with all intervals that are known.
ReportFigure IntervalFigure(const ReportSource& source);

// What was measured, with skeletons where they were recorded, and what is predicted.
Animation AnimationOf(const RecordingView& view);

// Hips of the recordings that are predicted best, in the middle and worst; none without recordings.
std::optional<ReportFigure> TypicalFigure(const ReportSource& source);

// Of a table of colours as wide as the page.
inline constexpr double kWidestMap = 1000;

}  // namespace pushid
