// ident: how sure, for a terminal.

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/fit/interval_agreement.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/statistics.h"
#include "ident/report/fit_command.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr size_t kWorstRecordings = 5;
constexpr int kFewUnits = 5;  // of fewer a bootstrap has too few distinct resamples

std::string OrDash(double value, const std::optional<Interval>& interval) {
  return interval ? IntervalText(value, interval->lower, interval->upper) : "-";
}

std::string Disagreements(const std::vector<Agreement>& rows) {
  std::string names;
  for (const Agreement& row : rows) {
    if (row.ratio <= kDisagreement) continue;
    names += (names.empty() ? "" : ", ") + row.name;
  }
  if (names.empty()) return "the widths agree within a factor of 1.5\n";
  return "widths differ by more than a factor of 1.5, use the widest: " + names + "\n";
}

std::string StartText(const StartDiagnostics& start) {
  std::string text;
  for (const std::string& note : start.notes) text += "start: " + note + "\n";
  for (const std::string& finding : FindingTexts(start.findings)) {
    text += "warning: " + finding + "\n";
  }
  return text;
}

// The parameter that leaving a recording out moves most, in standard errors.
std::string LargestMove(const Leverage& leverage, const std::string& recording) {
  for (size_t g = 0; g < leverage.recordings.size(); ++g) {
    if (leverage.recordings[g] != recording) continue;
    const std::vector<double>& row = leverage.in_errors[g];
    const auto most = std::max_element(
        row.begin(), row.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    if (most == row.end()) return "";
    return leverage.parameters[static_cast<size_t>(most - row.begin())] + " " + Rounded(*most, 2);
  }
  return "";
}

std::string RecordingsText(const Diagnostics& d) {
  std::vector<const RecordingDiagnostics*> worst;
  if (d.whiteness.empty()) return "";  // nobody saw the motion
  for (const RecordingDiagnostics& r : d.recordings) worst.push_back(&r);
  std::sort(worst.begin(), worst.end(),
            [](const auto* a, const auto* b) { return a->explained < b->explained; });
  if (worst.size() > kWorstRecordings) worst.resize(kWorstRecordings);
  TextTable table({"explained least", "% of motion", "cost", "down-weighted frames",
                   "change without it (std errors)"},
                  {true, false, false, false, true});
  for (const RecordingDiagnostics* r : worst) {
    table.Add({r->id, Rounded(r->explained, 3), Rounded(r->cost, 3), r->outliers.size(),
               LargestMove(d.leverage, r->id)});
  }
  return worst.empty() ? "" : table.ToString();
}

std::string WhitenessText(const std::vector<Whiteness>& whiteness) {
  std::string text;
  for (const Whiteness& w : whiteness) {
    if (w.channel != "hip x" && w.channel != "theta") continue;
    text += "errors of " + w.channel + ": lag-1 correlation " +
            Rounded(w.autocorrelation.front(), 2) + " (white: +-" + Rounded(w.mean_band, 1) + ")\n";
  }
  return text.empty()
             ? ""
             : text + "residuals within a recording may be correlated: use the clustered errors\n";
}

}  // namespace

std::string DiagnosticsText(const FittedModel& model) {
  const Diagnostics& d = model.fit.diagnostics;
  std::string text = model.fit.verdict.checked() ? AssumptionTable(model.fit).ToString() : "";
  text += StartText(d.start) + RecordingsText(d) + WhitenessText(d.whiteness);
  bool unkept = false;
  for (const Advice& advice : model.advice) {
    text += "advice: " + advice.sentence + "\n";
    if (advice.command.empty()) continue;
    text += "  " + CommandFor(model.provenance, advice.command) + "\n";
    unkept = unkept || (model.provenance.model_file.empty() && NamesModel(advice.command));
  }
  if (unkept) text += "FILE: keep the model first; fit again with --model_out=FILE\n";
  return text;
}

TextTable AgreementTable(const FittedModel& model) {
  TextTable table({"95 % intervals", "value", "clustered", "profile", "bootstrap", "unit", "class",
                   "by the data alone"},
                  {true, false, true, true, true, true, true, true});
  for (const Agreement& row : CompareIntervals(model)) {
    table.Add({row.name, Rounded(row.value, 4), OrDash(row.value, row.clustered),
               OrDash(row.value, row.profile), OrDash(row.value, row.bootstrap), row.unit,
               row.classification ? NameOf(*row.classification) : "",
               row.by_data_alone ? NameOf(*row.by_data_alone) : ""});
  }
  return table;
}

std::string AgreementNote(const FittedModel& model) {
  const std::vector<Agreement> rows = CompareIntervals(model);
  if (rows.empty()) return "";
  std::string text = Disagreements(rows);
  if (model.bootstrap) text += "bootstrap " + ResamplingText(*model.bootstrap) + "\n";
  return text;
}

std::string ResamplingText(const Bootstrap& b) {
  const std::string what = b.drawn_by == ClusterBy::kSubject ? "people" : "recordings";
  const std::string number = b.drawn_from > 0 ? std::to_string(b.drawn_from) + " " : "";
  std::string text = "resampling " + number + what + ": " + std::to_string(b.values.size()) +
                     " of " + std::to_string(b.replicas) + " replicas, seed " +
                     std::to_string(b.seed);
  if (b.people_shared) {
    text +=
        "; people share recordings and cannot be drawn individually, so the correlation between a "
        "person's recordings is neglected";
  }
  if (b.drawn_from > 0 && b.drawn_from < kFewUnits) {
    text += "; of " + number + what + " only " + Rounded(DistinctResamples(b.drawn_from), 3) +
            " distinct resamples exist: its intervals are rough, and usually too narrow";
  }
  return text;
}

namespace {

using Pick = std::string EffectOfRecording::*;

void AddGroups(const RecordingEffect& effect, const char* title, Pick pick, TextTable* table) {
  std::map<std::string, std::vector<double>> groups;
  for (const EffectOfRecording& r : effect.recordings) groups[r.*pick].push_back(r.mean);
  if (groups.size() < 2) return;
  for (const auto& [name, effects] : groups) {
    const MeanAndError mean = MeanOf(effects);
    table->Add({title + (name.empty() ? "none" : name), effects.size(), Rounded(mean.mean, 2),
                effects.size() > 1 ? "+- " + Rounded(mean.error, 2) : std::string(),
                Rounded(std::exp(mean.mean), 3)});
  }
}

}  // namespace

std::string PopulationSentence(const RecordingEffect& effect) {
  const std::string scale = "the error of a rollout is " + Rounded(effect.error_scale, 3) +
                            " m half a second after a push that gives 1 m/s with its tail";
  if (effect.recordings.empty()) {
    return "No recording effect: it needs people who are pushed alone and a model with a push "
           "tail. " +
           scale + ".";
  }
  return "Recordings differ by a factor exp(b) on the push tail, b ~ N(0, w^2): w = " +
         Rounded(effect.spread, 3) + " +- " + Rounded(effect.spread_error, 2) + " (" +
         std::to_string(effect.clusters) +
         " clusters, left out one at a time). Each recording's own b removes " +
         Rounded(100.0 * effect.explained, 2) +
         " % of the mean squared error of the hip, divided by the push's speed; without it " +
         scale +
         ". Effects are shrunk towards 0 where a recording contains little information; alone: the "
         "estimate without shrinkage, looked for between -" +
         Rounded(kWidestEffect, 2) + " and " + Rounded(kWidestEffect, 2) + ".";
}

std::vector<EffectOfRecording> SortedEffects(const RecordingEffect& effect) {
  std::vector<EffectOfRecording> sorted = effect.recordings;
  std::sort(sorted.begin(), sorted.end(),
            [](const EffectOfRecording& a, const EffectOfRecording& b) {
              return std::tie(a.person, a.condition, a.mean, a.id) <
                     std::tie(b.person, b.condition, b.mean, b.id);
            });
  return sorted;
}

TextTable EffectGroupsTable(const RecordingEffect& effect) {
  TextTable table({"effect of", "recordings", "mean b", "", "factor"},
                  {true, false, false, true, false});
  AddGroups(effect, "person ", &EffectOfRecording::person, &table);
  AddGroups(effect, "condition ", &EffectOfRecording::condition, &table);
  return table;
}

TextTable EffectsTable(const RecordingEffect& effect) {
  TextTable table({"recording", "person", "condition", "b", "", "factor", "alone"},
                  {true, true, true, false, true, false, false});
  for (const EffectOfRecording& r : SortedEffects(effect)) {
    table.Add({r.id, r.person, r.condition, Rounded(r.mean, 2), "+- " + Rounded(r.error, 2),
               Rounded(std::exp(r.mean), 3),
               Rounded(r.alone, 2) + (AtEffectEdge(r) ? " or beyond" : "")});
  }
  return table;
}

std::string PopulationText(const RecordingEffect& effect) {
  std::string text = PopulationSentence(effect) + "\n";
  for (const TextTable& table : {EffectGroupsTable(effect), EffectsTable(effect)}) {
    if (!table.empty()) text += table.ToString();
  }
  return text;
}

}  // namespace pushid
