// ident: how sure, for a terminal.

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/option_names.h"
#include "ident/report/fit_command.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr size_t kWorstRecordings = 5;
constexpr int kFewUnits = 5;  // of fewer a bootstrap has too few distinct resamples

std::string OrDash(double value, const std::optional<Interval>& interval) {
  return interval ? IntervalText(value, interval->lower, interval->upper) : "-";
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

std::optional<Interval> ProfileInterval(const FittedModel& model, const std::string& name) {
  for (const Profile& p : model.profiles) {
    if (p.name == name) return Interval{0.0, p.lower95, p.upper95};
  }
  return std::nullopt;
}

std::optional<Interval> BootstrapInterval(const FittedModel& model, const std::string& name) {
  if (!model.bootstrap) return std::nullopt;
  const Bootstrap& b = *model.bootstrap;
  for (size_t i = 0; i < b.names.size(); ++i) {
    if (b.names[i] == name) return Interval{b.standard_error[i], b.lower95[i], b.upper95[i]};
  }
  return std::nullopt;
}

TextTable IntervalTable(const FittedModel& model) {
  TextTable table({"95 % intervals", "value", "clustered", "profile", "bootstrap", "unit", "class",
                   "by the data alone"},
                  {true, false, true, true, true, true, true, true});
  const auto add = [&](const auto& row) {
    const auto profile = ProfileInterval(model, row.name);
    const auto bootstrap = BootstrapInterval(model, row.name);
    if (!profile && !bootstrap) return;
    std::string classification, by_data_alone;
    for (const Profile& p : model.profiles) {
      if (p.name != row.name) continue;
      classification = NameOf(p.classification);
      if (p.by_data_alone) by_data_alone = NameOf(*p.by_data_alone);
    }
    table.Add({row.name, Rounded(row.value, 4), IntervalText(row.value, row.lower95, row.upper95),
               OrDash(row.value, profile), OrDash(row.value, bootstrap), row.unit, classification,
               by_data_alone});
  };
  for (const Estimate& e : model.fit.estimates) {
    if (e.status != EstimateStatus::kFixed) add(e);
  }
  for (const Combination& c : model.fit.derived) {
    if (c.standard_error != 0.0) add(c);
  }
  return table;
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

}  // namespace pushid
