#include "ident/report/fit_sections.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

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
namespace {

// -2 log likelihood, AIC, BIC and what they may be compared with; there must be a likelihood.
std::string LikelihoodText(const FitResult& result) {
  const LikelihoodScore& score = *result.likelihood;
  return "likelihood " + NameOf(result.options.likelihood) + ", noise " +
         NameOf(result.options.model.process_noise) + ": -2 log L " + Rounded(score.deviance, 7) +
         " of " + std::to_string(score.measured) + " values, AIC " + Rounded(score.Aic(), 7) +
         ", BIC " + Rounded(score.Bic(), 7) + " (" + CountText(score.parameters, "parameter") +
         "); compare only with models of the same likelihood and the same recordings\n" +
         (AnyPooled(result.options.table) ? "  units' deviations are not counted as parameters: "
                                            "compare only models with the same pooling\n"
                                          : "") +
         "  this likelihood is of single steps; settling, errors and outliers below are those of\n"
         "  rollouts";
}

// "motion: low-pass at 6 Hz (zero-phase Butterworth), resampled to 60 frames per second", and on a
// line of its own whether this is a bootstrap's replica; from the flags that a result keeps.
std::string PreparationText(const std::map<std::string, std::string>& configuration) {
  const auto flag = [&configuration](const char* name) {
    const auto found = configuration.find(name);
    double value = 0.0;
    return found != configuration.end() && ParseDouble(found->second, &value) ? value : 0.0;
  };
  std::string text;
  const double cutoff = flag("lowpass_hz"), rate = flag("resample_fps");
  if (cutoff > 0.0) text = "low-pass at " + Rounded(cutoff) + " Hz (zero-phase Butterworth)";
  if (rate > 0.0) {
    text += (text.empty() ? "" : ", ") + std::string("resampled to ") + Rounded(rate) +
            " frames per second";
  }
  if (!text.empty()) text = "motion: " + text + "\n";
  const double replica = flag("replica");
  if (replica > 0.0) {
    text += "recordings: drawn with replacement, as replica " + Rounded(replica) +
            " of a bootstrap (--replica)\n";
  }
  return text;
}

}  // namespace

ReportSection ShortSection(const FittedModel& model, const std::string& more) {
  ReportSection section{"short", "In short"};
  section.Say(DifferencesText(model.fit));
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
    const SolveStart& best = model.fit.starts[model.fit.best_start];
    facts.Add({"cost", Rounded(model.fit.cost, 6) + " after " +
                           CountText(best.iterations, "iteration") + ": " + best.message});
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

constexpr size_t kShownRecordings = 5;
constexpr double kWorstShown = -300.0;  // % explained; bars of worse ones are cut

// The recordings that are explained least, and the parameter that changes most without each.
TextTable WorstTable(std::vector<const RecordingDiagnostics*> worst, const Leverage& leverage) {
  TextTable table({"explained least", ">% of motion", ">cost", ">down-weighted frames",
                   "change without it (std errors)"});
  for (size_t k = worst.size(); k-- > 0 && worst.size() - k <= kShownRecordings;) {
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
  return section;
}

ReportSection LeverageSection(const FittedModel& model) {
  ReportSection section{"leverage", "Influence of each recording"};
  const Leverage& l = model.fit.diagnostics.leverage;
  std::multimap<double, size_t, std::greater<>> strongest;  // largest move, and whose it is
  for (size_t g = 0; g < l.recordings.size(); ++g) {
    double most = 0.0;
    for (double move : l.in_errors[g]) most = std::max(most, std::abs(move));
    if (!l.in_errors[g].empty()) strongest.emplace(most, g);
  }
  if (strongest.empty()) return section;
  std::vector<std::string> header = {"without"};
  for (const std::string& parameter : l.parameters) header.push_back(">" + parameter);
  TextTable table(header);
  for (const auto& [most, g] : strongest) {
    std::vector<std::string> cells = {l.recordings[g]};
    for (double move : l.in_errors[g]) cells.push_back(Rounded(move, 2));
    table.Add(cells);
  }
  table.Keep(kShownRecordings);
  section.Say(
      "Change of each parameter without one recording, in standard errors, for the recordings that "
      "change most: one step with the Hessian of all recordings, not a refit (on the 32 published "
      "recordings of single people refits differ from it by 15 %).");
  section.Show("", table);
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

}  // namespace pushid
