#include "ident/report/page/build_report.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"
#include "ident/report/fit_sections.h"
#include "ident/report/page/motion_sections.h"
#include "ident/report/parameter_sections.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

constexpr int kBandSamples = 100;

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
    const auto known =
        std::find_if(result.recordings.begin(), result.recordings.end(),
                     [&](const FittedRecording& r) { return r.id == view.run.recording.id; });
    if (known == result.recordings.end()) {
      view.note = "not among the recordings that were fitted";
    } else if (known->content_hash != view.run.recording.content_hash) {
      view.note = "its files have changed since the fit";
    }
    const RolloutStatus& status = view.run.prediction.status;
    if (!status.ok) {
      view.note += (view.note.empty() ? "" : "; ") + std::string(status.quantity) + " of person " +
                   std::to_string(status.person) + " leaves the model's domain at frame " +
                   std::to_string(status.frame);
    }
    if (view.note.empty()) fitted.push_back(view.run.recording);
  }
  BandOptions options;
  options.samples = kBandSamples;
  const std::vector<ParameterSet<double>> samples = SampleParameters(result, options);
  const std::vector<ErrorPath> errors = ErrorPaths(result, fitted);
  ParallelFor(
      static_cast<int>(views.size()), num_threads,
      [&](int i) {
        if (!views[i].run.prediction.status.ok) return;
        views[i].bands =
            ComputeBands(result, samples, errors, views[i].run.recording, options.seed);
      },
      progress);
  for (RecordingView& view : views) {
    ToLaboratory(view.run.recording.scene, &view.bands);
    view.run.prediction = InLaboratory(view.run.recording, std::move(view.run.prediction));
    view.run.recording = InLaboratory(std::move(view.run.recording));
  }
  return views;
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

constexpr double kDegrees = 180.0 / M_PI;
constexpr char kErrorLook[] = "fill:none;stroke:#8a8f98;stroke-width:1.2";

// Measured points with their errors over the model's line, over a logarithmic frequency. Phases go
// on without jumps: of the model from its lowest frequency on, of each point as near to the model
// as may be, or to the point before where there is no model.
Figure BodeFigure(const FrequencyResponse& response) {
  Chart gain{"gain, " + response.OutputUnit() + "/" + response.InputUnit(), "frequency, Hz"};
  gain.logarithmic_x = true;
  Chart phase = gain, coherence = gain;
  phase.title = "phase, degrees";
  coherence.title = "coherence";
  gain.logarithmic_y = true;
  coherence.y_from = 0.0, coherence.y_to = 1.05;
  double lowest = INFINITY, highest = -INFINITY;
  const auto add = [](double x, double value, double error, Chart* chart) {
    if (error > 0.0) chart->lines.push_back({{{x, value - error}, {x, value + error}}, kErrorLook});
    chart->lines.push_back({{{x, value}}, kMeasuredLook, true});
  };
  ChartLine gains{{}, kPredictedLook}, phases{{}, kPredictedLook};
  std::optional<double> beside;
  // The multiple of 360 degrees away that is nearest to what stands beside it.
  const auto nearest = [&beside](double angle) {
    return beside ? *beside + std::remainder(kDegrees * angle - *beside, 360.0) : kDegrees * angle;
  };
  for (const FrequencyBin& bin : response.bins) {
    const double x = std::log10(bin.hz), log = bin.log_gain / M_LN10;
    const double model = (response.has_model ? bin.model_log_gain : bin.log_gain) / M_LN10;
    const double error = bin.log_gain_error / M_LN10;
    if (response.has_model) {
      beside = nearest(bin.model_phase);
      gains.points.emplace_back(x, model);
      phases.points.emplace_back(x, *beside);
    }
    const double measured = nearest(bin.phase);
    if (!response.has_model) beside = measured;
    add(x, log, error, &gain);
    add(x, measured, kDegrees * bin.phase_error, &phase);
    add(x, bin.coherence, 0.0, &coherence);
    lowest = std::min({lowest, log - error, model}),
    highest = std::max({highest, log + error, model});
  }
  Figure figure;
  figure.legend = {{"measured, one standard error", kErrorLook}};
  if (response.has_model) {
    gain.lines.insert(gain.lines.begin(), gains), phase.lines.insert(phase.lines.begin(), phases);
    figure.legend.push_back({"model", kPredictedLook});
  }
  gain.y_from = std::floor(lowest);  // a power of ten at both ends
  gain.y_to = std::max(std::ceil(highest), *gain.y_from + 1.0);
  figure.panels = {gain, phase, coherence};
  return figure;
}

}  // namespace

Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   int num_threads, const JobProgress& progress) {
  const FitResult& result = model.fit;
  Report report;
  report.title = "pushid: " + std::to_string(result.recordings.size()) + " recordings (" +
                 model.provenance.setting + "), preset " + result.options.preset;
  report.subtitle =
      "parameters, their uncertainty and their predictions; pushid " + model.provenance.version;
  ReportSource source{model};
  source.views = ViewRecordings(result, recordings, num_threads, progress);
  const IdentifiedModel identified = ModelOf(result);
  source.frequency = FrequencyResponses(identified, MakePendulumRecordings(recordings));
  std::vector<PropagationScore> scores;
  for (const RecordingView& view : source.views) {
    const FormationRun& run = view.run;
    if (run.recording.num_people() < 2 || !run.prediction.status.ok) continue;
    scores.push_back(ScorePropagation(run.recording, run.prediction.hip));
    AddContactFigures(identified, run.prediction, &scores.back());
  }
  std::vector<const PropagationScore*> all;
  for (const PropagationScore& score : scores) all.push_back(&score);
  source.propagation = SummarizePropagation(all);
  for (RenderSection* const render : kSections) report.sections.push_back(render(source));
  return report;
}

std::string DetailsText(const FittedModel& model) { return ToText(BuildReport(model, {})); }

ReportSection StepSection(const ReportSource& source) {
  ReportSection section{"steps", "Who steps"};
  if (!source.fit.step_probability) return section;
  std::vector<StepPrediction> predictions;
  for (const RecordingView& view : source.views) {
    const auto steps = StepPredictions(view.run.recording, view.run.prediction);
    predictions.insert(predictions.end(), steps.begin(), steps.end());
  }
  const StepScore score = ScoreSteps(predictions);
  if (!score.known()) return section;
  section.tables.push_back(
      {"who steps in the recordings shown here, which were fitted; pushid-crossvalidate scores "
       "others",
       StepScoresTable({{"predicted", &score}})});
  // Shares over probability, beside the diagonal.
  Chart chart{"who steps: share over probability", "predicted probability of a step"};
  chart.y_from = 0.0;
  chart.y_to = 1.0;
  ChartPoints shares;
  TextTable numbers({">tracks", ">predicted", ">observed"});
  for (const StepFifth& fifth : score.fifths) {
    shares.emplace_back(fifth.predicted, fifth.observed);
    numbers.Add({fifth.tracks, fifth.predicted, fifth.observed});
  }
  chart.lines = {{{{0.0, 0.0}, {1.0, 1.0}}, kLimitLook},
                 {shares, kPredictedLook},
                 {shares, kPredictedLook, true}};
  section.figures.push_back({"step_reliability",
                             "Share of people who stepped, by fifths of the predicted probability.",
                             {{}, {chart}},
                             numbers});
  return section;
}

ReportSection GroupSection(const ReportSource& source) {
  ReportSection section{"groups", "Groups"};
  if (source.propagation.recordings == 0) return section;
  section.tables.push_back(
      {"how the push travels through the groups shown here, +- a standard error over recordings",
       PropagationTable({{"predicted and measured", &source.propagation}})});
  return section;
}

ReportSection FrequencySection(const ReportSource& source) {
  ReportSection section{"frequency", "Frequency response"};
  if (source.frequency.empty()) return section;
  section.Say(
      "How people answer what disturbs them on and on, frequency by frequency: the cross spectrum "
      "of the answer and the disturbance over the spectrum of the disturbance, of each person "
      "first, then the mean of log gain and phase over people. Frequencies whose coherence could "
      "be chance are left out. The model's curve is the closed form of its linearized loop, with "
      "the same people's parameters.");
  const std::string without = WithoutLinearLoop(source.fit.options.model);
  section.Say(without.empty() ? "" : "There is no curve: " + without + ".");
  for (const FrequencyResponse& response : source.frequency) {
    const size_t people = response.people.size();
    const std::string caption =
        response.Name() + ": " + CountText(response.recordings, "recording") + " of " +
        CountText(people, "person", "people") + "; the excited frequencies, in periods of " +
        Rounded(response.segment_s, 3) + " s" +
        (response.output == LoopOutput::kAngle ? "" : "; torque by force platforms") +
        (people == 1 ? "; errors by the coherence." : "; errors from person to person.");
    section.figures.push_back(
        {"frequency_" + response.Key(), caption, BodeFigure(response), FrequencyTable({response})});
  }
  return section;
}

}  // namespace pushid
