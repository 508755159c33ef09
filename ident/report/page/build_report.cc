// ident: the order of a report.
#include "ident/report/page/build_report.h"

#include <algorithm>
#include <optional>

#include "ident/parameters/option_names.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/page/sections.h"
#include "ident/validation/study_plan.h"

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

namespace {

constexpr int kBandSamples = 100;

std::string NoteOf(const FitResult& result, const PendulumRecording& recording,
                   const Prediction& prediction) {
  const auto fitted =
      std::find_if(result.recordings.begin(), result.recordings.end(),
                   [&recording](const FittedRecording& r) { return r.id == recording.id; });
  std::string note;
  if (fitted == result.recordings.end()) {
    note = "not among the recordings that were fitted";
  } else if (fitted->content_hash != recording.content_hash) {
    note = "its files have changed since the fit";
  }
  if (prediction.status.ok) return note;
  return note + (note.empty() ? "" : "; ") + std::string(prediction.status.quantity) +
         " of person " + std::to_string(prediction.status.person) +
         " leaves the model's domain at frame " + std::to_string(prediction.status.frame);
}

}  // namespace

std::vector<RecordingView> ViewRecordings(const FitResult& result,
                                          const std::vector<Recording>& recordings, int num_threads,
                                          const JobProgress& progress) {
  const IdentifiedModel model = ModelOf(result);
  std::vector<RecordingView> views(recordings.size());
  std::vector<PendulumRecording> fitted;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingView& view = views[i];
    view.recording = &recordings[i];
    view.run.recording = MakePendulumRecording(recordings[i], model.mapping);
    view.run.prediction = Predict(model, view.run.recording);
    view.note = NoteOf(result, view.run.recording, view.run.prediction);
    if (view.note.empty()) fitted.push_back(view.run.recording);
  }
  BandOptions options;
  options.samples = kBandSamples;
  const Result<std::vector<ParameterSet<double>>> samples = SampleParameters(result, options);
  if (!samples.ok()) return views;
  const std::vector<ErrorPath> errors = ErrorPaths(result, fitted);
  ParallelFor(
      static_cast<int>(views.size()), num_threads,
      [&](int i) {
        if (!views[i].run.prediction.status.ok) return;
        views[i].bands =
            ComputeBands(result, samples.value(), errors, views[i].run.recording, options.seed);
      },
      progress);
  return views;
}

PropagationSummary PropagationOf(const FitResult& result, const std::vector<RecordingView>& views) {
  const IdentifiedModel model = ModelOf(result);
  std::vector<PropagationScore> scores;
  for (const RecordingView& view : views) {
    const FormationRun& run = view.run;
    if (run.recording.num_people() < 2 || !run.prediction.status.ok) continue;
    scores.push_back(ScorePropagation(run.recording, run.prediction.hip));
    AddContactFigures(model, run.recording, run.prediction, &scores.back());
  }
  std::vector<const PropagationScore*> all;
  for (const PropagationScore& score : scores) all.push_back(&score);
  return SummarizePropagation(all);
}

}  // namespace pushid
