#include "ident/report/fit_sections.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/fit_options.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/problem/behaviour.h"
#include "ident/report/advice.h"
#include "ident/report/parameter_sections.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/covariance.h"

namespace pushid {

ReportSection ShortSection(const FittedModel& model, const std::string& more) {
  ReportSection section{"short", "In short"};
  section.Say(GainsText(model.fit));
  section.Say(BalanceText(model.fit));
  section.Say(more);
  section.Say("What to do next: " + (model.advice.empty() ? "predict a push that was not fitted."
                                                          : model.advice.front().sentence));
  section.Show("", ShortTable(model.fit));
  TextTable legend({"name", "unit", "meaning"});
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    legend.Add({e.name, e.unit == "1" ? "-" : e.unit, spec->meaning});
  }
  section.Show("what the names mean", legend);
  return section;
}

ReportSection SummarySection(const FittedModel& model) {
  ReportSection section{"summary", "What was fitted"};
  section.Say(model.fit.converged ? "The solve converged." : "The solve did NOT converge.");
  const FitOptions& o = model.fit.options;
  TextTable facts({"what", "value"});
  const bool may_lack = o.pool_by != kSubjectUnit && o.pool_by != kSettingLabel;
  facts.Add({"recordings",
             std::to_string(model.fit.recordings.size()) + " (" + model.provenance.setting + ")" +
                 (AnyPooled(o.table)
                      ? ", pooled by " + o.pool_by + (may_lack ? " (without one by setting)" : "")
                      : "")});
  facts.Add({"preset", o.preset});
  facts.Add({"posture", NameOf(o.model.posture)});
  facts.Add({"push", NameOf(o.model.push) + ", tail " + NameOf(o.model.push_tail)});
  facts.Add({"feet", model.fit.feet ? FeetText(*model.fit.feet, o.model.stance)
                                    : "stance " + NameOf(o.model.stance)});
  facts.Add({"self force", SelfForceText(o.self_force, o.model.learned.get())});
  if (RodMoves(o.model)) facts.Add({"rod", RodName(o.model.learned->rod)});
  facts.Add({"interaction", InteractionText(o.model)});
  if (model.fit.ok()) {
    const int iterations = model.fit.starts[model.fit.best_start].iterations;
    facts.Add(
        {"cost", Rounded(model.fit.cost, 6) + " after " + CountText(iterations, "iteration")});
  }
  const std::vector<RecordingDiagnostics>& recordings = model.fit.diagnostics.recordings;
  double explained = 0.0;
  for (const RecordingDiagnostics& r : recordings) explained += r.explained;
  if (!recordings.empty()) {
    facts.Add({"hip motion explained, mean over recordings",
               Rounded(explained / static_cast<double>(recordings.size()), 3) + " %"});
  }
  section.Show("", facts);
  if (const std::string network = NetworkText(model.fit); !network.empty()) {
    section.Say("Learned terms: " + network + ".");
  }
  if (model.fit.likelihood) section.Say(LikelihoodText(model.fit));
  section.Say(PreparationText(model.provenance.configuration));
  for (const std::string& warning : WarningTexts(model.fit)) section.Say("Warning: " + warning);
  return section;
}

std::vector<std::string> WarningTexts(const FitResult& result) {
  std::vector<std::string> texts = GroupedWarnings(result.warnings);
  for (const std::string& finding : FindingTexts(result.diagnostics.start.findings)) {
    texts.push_back(finding);
  }
  return texts;
}

ReportSection AdviceSection(const FittedModel& model) {
  ReportSection section{"advice", "What to try next"};
  bool unkept = false;
  for (const Advice& advice : model.advice) {
    section.advice.emplace_back(advice.sentence, CommandFor(model.provenance, advice.command));
    unkept = unkept || (model.provenance.model_file.empty() && NamesModel(advice.command));
  }
  if (unkept) section.Say("FILE is the model, which --model_out=FILE of pushid-fit keeps.");
  return section;
}

ReportSection BehaviourSection(const FittedModel& model) {
  ReportSection section{"behaviour", "After a push"};
  section.paragraphs = {BehaviourText(model.fit)};
  if (model.fit.step_probability) section.Say(StepProbabilityText(*model.fit.step_probability));
  section.tables.push_back(
      {"settling simulations: pushed and left alone", BehaviourTable(model.fit)});
  return section;
}

ReportSection ProvenanceSection(const FittedModel& model) {
  ReportSection section{"provenance", "Provenance"};
  section.paragraphs = {"pushid " + model.provenance.version + ", manifest " +
                        model.provenance.manifest + " (hash " + model.provenance.manifest_hash +
                        ")"};
  TextTable flags({"flag", "value"});
  for (const auto& [name, value] : model.provenance.configuration) flags.Add({"--" + name, value});
  section.Show("flags of the fit (empty: the preset's value)", flags);
  TextTable files({"recording", ">frames", "hash of its files"});
  for (const FittedRecording& r : model.fit.recordings) {
    files.Add({r.id, r.frames, r.content_hash});
  }
  section.Show("recordings", files);
  return section;
}

ReportSection LoopSection(const FittedModel& model) {
  ReportSection section{"loop", "The identified loop"};
  const TextTable loop = LoopTable(model.fit);
  if (loop.empty()) return section;
  section.Say(
      "These are numbers of the linearized model of a person of 85 kg with a rod of 0.95 m at "
      "rest. "
      "Phase and delay margin: how much later feedback may come; the last column: between which "
      "factors its gains may change.");
  section.Show("", loop);
  return section;
}

namespace {

constexpr size_t kMostOutliers = 20, kWorstRecordings = 5;
constexpr double kStrongMove = 1.0;     // standard errors
constexpr double kWorstShown = -300.0;  // % explained; bars of worse ones are cut

// The recordings that are explained least, and the parameter that changes most without each.
TextTable WorstTable(std::vector<const RecordingDiagnostics*> worst, const Leverage& leverage) {
  TextTable table({"explained least", ">% of motion", ">cost", ">down-weighted frames",
                   "change without it (std errors)"});
  for (size_t k = worst.size(); k-- > 0 && worst.size() - k <= kWorstRecordings;) {
    std::string change;
    for (size_t g = 0; g < leverage.recordings.size(); ++g) {
      const std::vector<double>& row = leverage.in_errors[g];
      if (leverage.recordings[g] != worst[k]->id || row.empty()) continue;
      const auto most = std::max_element(
          row.begin(), row.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
      change = leverage.parameters[most - row.begin()] + " " + Rounded(*most, 2);
    }
    table.Add({worst[k]->id, Rounded(worst[k]->explained, 3), Rounded(worst[k]->cost, 3),
               worst[k]->outliers.size(), change});
  }
  return table;
}

// A bar for each recording, the best explained first.
Chart ExplainedChart(const std::vector<const RecordingDiagnostics*>& recordings) {
  double worst = 0.0;
  for (const RecordingDiagnostics* r : recordings) worst = std::min(worst, r->explained);
  worst = std::max(kWorstShown, worst);
  Chart chart{"", "hip motion explained, %"};
  chart.x_to = 100.0;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const double value = recordings[i]->explained;
    chart.y_categories.push_back(recordings[i]->id);
    chart.y_notes.push_back(Rounded(value, 3) + (value < worst ? " <<" : ""));
    chart.bars.push_back({static_cast<double>(i), 0.0, std::max(value, worst),
                          value < 0.0 ? "fill:#d55e00" : "fill:#3b82f6"});
  }
  return chart;
}

// Outliers in consecutive frames: "85 - 104".
struct OutlierRun {
  std::string recording;
  int person = 0, from = 0, to = 0;
  double worst = 0.0, weight = 1.0;
};

TextTable OutlierTable(const Diagnostics& d) {
  std::vector<OutlierRun> runs;
  for (const RecordingDiagnostics& r : d.recordings) {
    std::vector<Outlier> outliers = r.outliers;
    std::sort(outliers.begin(), outliers.end(), [](const Outlier& a, const Outlier& b) {
      return std::make_tuple(a.person, a.frame) < std::make_tuple(b.person, b.frame);
    });
    for (const Outlier& o : outliers) {
      const bool goes_on = !runs.empty() && runs.back().recording == r.id &&
                           runs.back().person == o.person && runs.back().to + 1 == o.frame;
      if (!goes_on) runs.push_back({r.id, o.person, o.frame, o.frame});
      OutlierRun& run = runs.back();
      run.to = o.frame;
      run.worst = std::max(run.worst, o.error);
      run.weight = std::min(run.weight, o.weight);
    }
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const OutlierRun& a, const OutlierRun& b) { return a.weight < b.weight; });
  if (runs.size() > kMostOutliers) runs.resize(kMostOutliers);
  TextTable table({"recording", ">person", "frames", ">worst error, sigmas", ">least weight kept"});
  for (const OutlierRun& run : runs) {
    table.Add({run.recording, run.person, std::to_string(run.from) + " - " + std::to_string(run.to),
               Rounded(run.worst, 3), Rounded(run.weight, 2)});
  }
  return table;
}

}  // namespace

ReportSection RecordingSection(const FittedModel& model) {
  ReportSection section{"recordings", "Recording by recording"};
  const Diagnostics& d = model.fit.diagnostics;
  if (d.recordings.empty() || d.whiteness.empty()) return section;  // or nobody saw the motion
  std::vector<const RecordingDiagnostics*> sorted;
  TextTable numbers({"recording", "explained_percent", "cost", "lag1", "ljung_box", "ljung_box_p",
                     "outlier_frames"});
  for (const RecordingDiagnostics& r : d.recordings) {
    sorted.push_back(&r);
    numbers.Add({r.id, r.explained, r.cost, r.lag1, r.ljung_box, r.ljung_box_p, r.outliers.size()});
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto* a, const auto* b) { return a->explained > b->explained; });
  section.figures.push_back({"explained",
                             "Share of the hip's horizontal motion that the model explains; below "
                             "zero it is worse than predicting no motion.",
                             {{}, {ExplainedChart(sorted)}},
                             numbers});
  section.Show("", WorstTable(sorted, d.leverage));
  section.Show("intervals that have less than half their weight in the robust loss (the 20 worst)",
               OutlierTable(d));
  return section;
}

ReportSection LeverageSection(const FittedModel& model) {
  ReportSection section{"leverage", "Influence of each recording"};
  const Leverage& l = model.fit.diagnostics.leverage;
  if (l.recordings.empty()) return section;
  Chart map{"change without it, standard errors"};
  map.x_categories = l.parameters;
  map.full_cell = kStrongMove;
  map.width = kWidestMap;
  std::vector<size_t> order(l.recordings.size());
  std::iota(order.begin(), order.end(), 0);
  const auto largest = [&l](size_t g) {
    double most = 0.0;
    for (double move : l.in_errors[g]) most = std::max(most, std::abs(move));
    return most;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return largest(a) > largest(b); });
  std::vector<std::string> header = {"recording"};
  for (size_t p = 0; p < l.parameters.size(); ++p) {
    header.push_back(l.parameters[p] + " (" + l.units[p] + ")");
  }
  TextTable numbers(header);
  for (size_t g : order) {
    map.y_categories.push_back(l.recordings[g]);
    map.cells.push_back(l.in_errors[g]);
    std::vector<std::string> cells = {l.recordings[g]};
    for (double change : l.change[g]) cells.push_back(DoubleText(change));
    numbers.Add(cells);
  }
  section.figures.push_back(
      {"leverage",
       "Change of each parameter without one recording, in standard errors: one step with the "
       "Hessian of all recordings, not a refit (on the 32 published recordings of single people "
       "refits differ from it by 15 %).",
       {{}, {map}},
       numbers});
  return section;
}

ReportSection ResidualSection(const FittedModel& model) {
  ReportSection section{"residuals", "Residuals"};
  const std::vector<Whiteness>& channels = model.fit.diagnostics.whiteness;
  if (channels.empty()) return section;
  section.paragraphs = {
      "Autocorrelation of the residuals, and their correlation with the push, by lag in frames: "
      "the mean over recordings (line) with two standard errors, and the band of white noise "
      "(orange). Autocorrelated residuals mean that frames are not independent (so only clustered "
      "errors are valid); residuals correlated with the push mean that the model misses part of "
      "the response to it."};
  Figure figure;
  TextTable numbers({"channel", "kind", "lag", "correlation", "standard_error", "white_band"});
  TextTable tests =
      TextTable::OfNumbers({"channel", "lag-1 correlation", "white +-", "Ljung-Box", "p"});
  const auto add = [&](const Whiteness& w, const char* kind, const std::string& title,
                       const std::vector<double>& values, const std::vector<double>& errors,
                       int first_lag) {
    Chart& chart = figure.panels.emplace_back(Chart{title, "lag, frames"});
    chart.Shrink();
    ChartBand spread{{}, {}, kNarrowBandLook},
        white{{}, {}, "stroke:none;fill:#e69f00;fill-opacity:.2"};
    ChartLine line{{}, kPredictedLook};
    for (size_t k = 0; k < values.size(); ++k) {
      const int lag = first_lag + static_cast<int>(k);
      const double error = k < errors.size() ? errors[k] : 0.0;
      line.points.emplace_back(lag, values[k]);
      spread.lower.emplace_back(lag, values[k] - 2.0 * error);
      spread.upper.emplace_back(lag, values[k] + 2.0 * error);
      white.lower.emplace_back(lag, -w.mean_band);
      white.upper.emplace_back(lag, w.mean_band);
      numbers.Add({w.channel, kind, lag, values[k], error, w.mean_band});
    }
    chart.bands = {white, spread};
    chart.lines = {line};
    chart.y_from = -1.0;
    chart.y_to = 1.0;
  };
  for (const Whiteness& w : channels) {
    add(w, "own", w.channel, w.autocorrelation, w.error, 1);
    add(w, "push", w.channel + " and push", w.push, w.push_error, 0);
    tests.Add({w.channel, w.autocorrelation.empty() ? "-" : Rounded(w.autocorrelation[0], 2),
               Rounded(w.mean_band, 1), Rounded(w.ljung_box, 3), Rounded(w.ljung_box_p, 2)});
  }
  section.Show("tests of whiteness", tests);
  section.figures.push_back(
      {"residual_correlations", "Correlations of the residuals.", figure, numbers});
  return section;
}

ReportSection SolveSection(const FittedModel& model) {
  ReportSection section{"solve", "Solver convergence"};
  TextTable starts(
      {"start", ">cost", ">iterations", "converged", ">failed recordings", "solver's message"});
  for (const SolveStart& s : model.fit.starts) {
    starts.Add({s.kind, s.usable ? Rounded(s.cost, 6) : "-", s.iterations,
                s.converged ? "yes" : "no", s.failed.size(), s.message});
  }
  section.Show("solved from", starts);
  const std::vector<TracePoint>& trace = model.fit.diagnostics.trace;
  if (trace.size() < 2) return section;
  double lowest = HUGE_VAL;
  for (const TracePoint& point : trace) lowest = std::min(lowest, point.cost);
  // A likelihood's costs may be negative: they count from 1 below the lowest.
  const double base = lowest > 0.0 ? 0.0 : lowest - 1.0;
  Chart cost, gradient;
  cost.title = base == 0.0 ? "cost" : "1 + cost above the lowest";
  gradient.title = "largest gradient component";
  ChartLine c{{}, kPredictedLook, false}, g = c;
  TextTable numbers({"step", "horizon_frames", "iteration", "cost", "gradient"});
  for (size_t i = 0; i < trace.size(); ++i) {
    const double step = static_cast<double>(i);
    c.points.emplace_back(step, std::log10(std::max(1e-300, trace[i].cost - base)));
    if (trace[i].gradient > 0.0) g.points.emplace_back(step, std::log10(trace[i].gradient));
    numbers.Add({i, trace[i].horizon, trace[i].iteration, trace[i].cost, trace[i].gradient});
  }
  cost.lines = {c};
  gradient.lines = {g};
  for (Chart* chart : {&cost, &gradient}) {
    chart->x_label = "iteration, over all horizons";
    chart->logarithmic_y = true;
    for (size_t i = 1; i < trace.size(); ++i) {
      if (trace[i].horizon != trace[i - 1].horizon) chart->marks.push_back(static_cast<double>(i));
    }
  }
  section.figures.push_back(
      {"trace",
       model.fit.options.likelihood == Likelihood::kTrajectory
           ? "The best start. The cost jumps where the horizon grows (lines) and where "
             "the weights are estimated anew."
           : "The best start: Fisher scoring, then BFGS.",
       {{}, {cost, gradient}},
       numbers});
  return section;
}

}  // namespace pushid
