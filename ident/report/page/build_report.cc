#include "ident/report/page/build_report.h"

#include <algorithm>

#include "ident/prediction/prediction.h"
#include "ident/report/fit_sections.h"
#include "ident/report/page/motion_sections.h"
#include "ident/report/page/prediction_sections.h"
#include "ident/report/parameter_sections.h"

namespace pushid {
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

// The recordings must outlive the views.
std::vector<RecordingView> ViewRecordings(const FitResult& result,
                                          const std::vector<Recording>& recordings, int num_threads,
                                          const JobProgress& progress) {
  const IdentifiedModel model = ModelOf(result);
  std::vector<RecordingView> views(recordings.size());
  std::vector<PendulumRecording> fitted;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingView& view = views[i];
    view.recording = &recordings[i];
    view.run.recording = MakePendulumRecording(recordings[i]);
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
  for (RecordingView& view : views) {
    ToLaboratory(view.run.recording.scene, &view.bands);
    view.run.prediction = InLaboratory(view.run.recording, std::move(view.run.prediction));
    view.run.recording = InLaboratory(std::move(view.run.recording));
  }
  return views;
}

// How pushes travel through the recordings of several people that the model predicts.
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

using RenderSection = ReportSection(const ReportSource& source);

template <ReportSection (*kRender)(const FittedModel&)>
ReportSection OfModel(const ReportSource& source) {
  return kRender(source.model);
}

// The sections in the order of the page.
constexpr RenderSection* kSections[] = {LeadSection,
                                        OfModel<SummarySection>,
                                        OfModel<ParameterSection>,
                                        OfModel<ContrastSection>,
                                        OfModel<UnitSection>,
                                        OfModel<IdentifiabilitySection>,
                                        OfModel<ProfileSection>,
                                        OfModel<BootstrapSection>,
                                        OfModel<HorizonCheckSection>,
                                        OfModel<BehaviourSection>,
                                        OfModel<LoopSection>,
                                        FrequencySection,
                                        StepSection,
                                        GroupSection,
                                        FigureSection,
                                        MotionSection,
                                        OfModel<RecordingSection>,
                                        OfModel<LeverageSection>,
                                        OfModel<ResidualSection>,
                                        OfModel<SolveSection>,
                                        OfModel<AdviceSection>,
                                        OfModel<ProvenanceSection>};

}  // namespace

Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   const BuildReportOptions& options) {
  const FitResult& result = model.fit;
  Report report;
  report.title = "pushid: " + std::to_string(result.recordings.size()) + " recordings (" +
                 model.provenance.setting + "), preset " + result.options.preset;
  report.subtitle =
      "parameters, their uncertainty and their predictions; pushid " + model.provenance.version;
  ReportSource source{model};
  source.views = ViewRecordings(result, recordings, options.num_threads, options.progress);
  const IdentifiedModel identified = ModelOf(result);
  source.frequency = FrequencyResponses(identified, MakePendulumRecordings(recordings));
  source.propagation = PropagationOf(result, source.views);
  for (RenderSection* const render : kSections) report.sections.push_back(render(source));
  return report;
}

}  // namespace pushid
