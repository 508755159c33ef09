// ident: how sure, for a terminal.
#include "ident/report/confidence_text.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/loading/recording_warnings.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/option_names.h"
#include "ident/results/interval_agreement.h"

namespace pushid {
namespace {

constexpr size_t kWorstRecordings = 5;
constexpr int kFewUnits = 5;  // of fewer a bootstrap has too few distinct resamples

std::string IntervalText(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  const auto side = [](double value) {
    return std::isfinite(value) ? Rounded(value, 4) : std::string("open");
  };
  return "[" + side(interval->lower) + ", " + side(interval->upper) + "]";
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
  for (const std::string& warning : GroupedWarnings(start.unit_warnings))
    text += "units? " + warning + "\n";
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
  for (const RecordingDiagnostics& r : d.recordings) worst.push_back(&r);
  std::sort(worst.begin(), worst.end(),
            [](const auto* a, const auto* b) { return a->explained < b->explained; });
  if (worst.size() > kWorstRecordings) worst.resize(kWorstRecordings);
  TextTable table({"explained least", "% of motion", "cost", "down-weighted frames",
                   "change without it (std errors)"},
                  {true, false, false, false, true});
  for (const RecordingDiagnostics* r : worst) {
    table.Add({r->id, Rounded(r->explained, 3), Rounded(r->cost, 3),
               std::to_string(r->outliers.size()), LargestMove(d.leverage, r->id)});
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
  std::string text = StartText(d.start) + RecordingsText(d) + WhitenessText(d.whiteness);
  for (const Advice& advice : model.advice) {
    text += "advice: " + advice.sentence + "\n";
    if (!advice.command.empty()) text += "  " + advice.command + "\n";
  }
  return text;
}

TextTable AgreementTable(const FittedModel& model) {
  TextTable table({"95 % intervals", "value", "clustered", "profile", "bootstrap", "unit", "class",
                   "by the data alone"},
                  {true, false, true, true, true, true, true, true});
  for (const Agreement& row : CompareIntervals(model)) {
    table.Add({row.name, Rounded(row.value, 4), IntervalText(row.clustered),
               IntervalText(row.profile), IntervalText(row.bootstrap), row.unit,
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

}  // namespace pushid
