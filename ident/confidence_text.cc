// ident: how sure, for a terminal.
#include "ident/confidence_text.h"

#include <cmath>

#include "ident/confidence.h"
#include "ident/option_names.h"
#include "ident/report_text.h"
#include "ident/text_table.h"

namespace pushid {
namespace {

constexpr double kDisagreement = 1.5;  // ratio of widths that is worth a word

std::string IntervalText(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  const auto side = [](double value) {
    return std::isfinite(value) ? Significant(value) : std::string("open");
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
  return "widths differ by more than a factor of 1.5, trust the widest: " + names + "\n";
}

}  // namespace

std::string AgreementText(const FitResult& result) {
  const std::vector<Agreement> rows = CompareIntervals(result);
  if (rows.empty()) return "";
  TextTable table({"95 % intervals", "value", "clustered", "profile", "bootstrap", "unit", "class"},
                  {true, false, true, true, true, true, true});
  for (const Agreement& row : rows) {
    table.Add({row.name, Significant(row.value), IntervalText(row.clustered),
               IntervalText(row.profile), IntervalText(row.bootstrap), row.unit,
               row.classification ? NameOf(*row.classification) : ""});
  }
  std::string text = table.ToString() + Disagreements(rows);
  if (result.bootstrap) {
    text += "bootstrap over recordings: " + std::to_string(result.bootstrap->values.size()) +
            " of " + std::to_string(result.bootstrap->replicas) + " replicas, seed " +
            std::to_string(result.bootstrap->seed) + "\n";
  }
  return text;
}

}  // namespace pushid
