// ident: the order of a report.
#include "ident/report/page/build_report.h"

#include <algorithm>
#include <optional>

#include "ident/parameters/option_names.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/page/sections.h"
#include "ident/validation/error_parts.h"

namespace pushid {
namespace {

// The design needs the fit's own recordings, all of them and as they were.
ExperimentDesign DesignOf(const FitResult& result, const std::vector<RecordingView>& views) {
  ExperimentDesign none;
  none.refused = "it needs all recordings that were fitted, as they were then, each of one person";
  if (views.size() != result.recordings.size() || result.best_start < 0) return none;
  std::vector<PendulumRecording> recordings;
  for (const RecordingView& view : views) {
    const bool same = std::any_of(
        result.recordings.begin(), result.recordings.end(), [&](const FittedRecording& r) {
          return r.id == view.run.recording.id && r.content_hash == view.run.recording.content_hash;
        });
    // A candidate is one person alone.
    if (!same || view.run.recording.num_people() > 1) return none;
    recordings.push_back(view.run.recording);
  }
  const FitProblem problem(recordings, result.options);
  const std::optional<FitPoint> point = problem.PointAt(result.starts[result.best_start].to.Flat());
  if (!point) return none;
  const FitPoint& estimate = *point;
  return DesignExperiments(problem, estimate, result.uncertainty, ErrorPartsAt(problem, estimate),
                           DefaultCandidates(recordings));
}

}  // namespace

Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   const BuildReportOptions& options) {
  const FitResult& result = model.fit;
  Report report;
  report.title = "pushid: " + std::to_string(result.recordings.size()) + " recordings (" +
                 model.provenance.setting + "), preset " + result.options.preset;
  report.subtitle =
      "friction, gains and push tails, their uncertainty and their predictions; pushid " +
      model.provenance.version;
  const std::vector<RecordingView> views =
      ViewRecordings(result, recordings, options.num_threads, options.progress);
  const PropagationSummary propagation = PropagationOf(result, views);
  report.sections = {LeadSection(model, propagation),
                     SummarySection(model),
                     ParameterSection(model),
                     UnitSection(model),
                     IdentifiabilitySection(model),
                     ProfileSection(model),
                     BootstrapSection(model),
                     PriorCheckSection(model),
                     PushCheckSection(model),
                     HorizonCheckSection(model),
                     BehaviourSection(model),
                     PopulationSection(model),
                     StepSection(model, views),
                     GroupSection(views, propagation),
                     FigureSection(views),
                     MotionSection(views),
                     VisualCheckSection(model, views),
                     RecordingSection(model),
                     LeverageSection(model),
                     ResidualSection(model),
                     SolveSection(model),
                     DesignSection(DesignOf(result, views)),
                     AdviceSection(model),
                     ProvenanceSection(model)};
  return report;
}

}  // namespace pushid
