// ident: the sections of a report: a row each. A section with nothing to say stays empty and is
// left out. A new one is a renderer in a file of its own, its name and its row here.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/bodies/animation.h"
#include "ident/prediction/visual_check.h"
#include "ident/report/page/build_report.h"

namespace pushid {

// What sections are made of.
struct ReportSource {
  const FittedModel& model;
  const FitResult& fit = model.fit;
  std::vector<RecordingView> views = {};  // of the recordings that are shown; may be none
  PropagationSummary propagation = {};    // of those
  VisualCheck check = {};                 // with those
  // Of the recordings that are shown, on the ground that moves (prediction/visual_check.h).
  std::vector<FrequencyResponse> frequency = {};
  std::vector<PersonSway> sway = {};
};

using RenderSection = ReportSection(const ReportSource& source);

struct SectionRow {
  const char* id;
  const char* title;  // where the section gives itself none
  RenderSection* render;
};

RenderSection LeadSection, SummarySection, ParameterSection, ContrastSection, UnitSection,
<<<<<<< HEAD
    IdentifiabilitySection, ProfileSection, BootstrapSection, HorizonCheckSection, BehaviourSection,
    LoopSection, FrequencySection, SwaySection, PopulationSection, ForecastSection, StepSection,
    GroupSection, FigureSection, MotionSection,
=======
    IdentifiabilitySection, ProfileSection, BootstrapSection, PriorCheckSection, PushCheckSection,
    HorizonCheckSection, BehaviourSection, LoopSection, FrequencySection, SwaySection,
    PopulationSection, StepSection, GroupSection, FigureSection, MotionSection,
>>>>>>> 68040e1d (Two forecasters after first frames, physics and unknown input, by one rule; the stack of four, the band of the unknown force and drawn futures of them are gone)
    VisualCheckSection, RecordingSection, LeverageSection, ResidualSection, SolveSection,
    DesignSection, AdviceSection, ProvenanceSection;

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
    {"sway", "Quiet stance", SwaySection},
    {"population", "How recordings differ", PopulationSection},
    {"steps", "Who steps", StepSection},
    {"groups", "Groups", GroupSection},
    {"figure", "Moving figure", FigureSection},
    {"motion", "Measured and predicted motion", MotionSection},
    {"checks", "Visual predictive check", VisualCheckSection},
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
