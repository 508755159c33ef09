// ident: a contrast in words.
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr double kHolmLevel = 0.05;
constexpr double kLeastShown = 1e-4;

std::string ProbabilityText(double p) {
  return p < kLeastShown ? "<" + Rounded(kLeastShown) : Rounded(p, 2);
}

std::string NumberOfPeople(size_t number) {
  return std::to_string(number) + (number == 1 ? " person" : " people");
}

std::string ComparedText(const Contrast& c) {
  std::string text = c.label + ": " + c.second + " less " + c.first + "; ";
  if (c.both.empty()) {
    return text + NumberOfPeople(c.only_first.size()) + " with " + c.first + ", " +
           NumberOfPeople(c.only_second.size()) + " with " + c.second +
           ", nobody in both: not paired";
  }
  text += NumberOfPeople(c.both.size()) + " in both (" + ListOfNames(c.both, kNamesInErrors) +
          "), compared with themselves";
  if (!c.only_first.empty()) {
    text += "; only with " + c.first + ": " + ListOfNames(c.only_first, kNamesInErrors);
  }
  if (!c.only_second.empty()) {
    text += "; only with " + c.second + ": " + ListOfNames(c.only_second, kNamesInErrors);
  }
  return text;
}

std::string DifferText(const Contrast& c) {
  std::string found;
  for (const ContrastRow& row : c.rows) {
    if (row.p_holm < kHolmLevel) found += (found.empty() ? "" : ", ") + row.name;
  }
  const std::string of =
      std::to_string(c.rows.size()) + (c.rows.size() == 1 ? " parameter" : " parameters");
  return found.empty() ? "after Holm's correction for " + of + " no difference is told from 0"
                       : "after Holm's correction for " + of + " these differ: " + found;
}

std::string EffectNote(const FitResult& result) {
  const Contrast& c = *result.contrast;
  std::string untold;
  for (const ContrastRow& row : c.rows) {
    if (!row.effect) untold += (untold.empty() ? "" : ", ") + row.name;
  }
  const FitOptions& o = result.options;
  const bool by_person = AnyPooled(o.table) && o.pool_by == kSubjectUnit;
  std::string text = "effects are in standard deviations between people";
  if (!by_person) text += ", by a second fit that lets them differ";
  if (!untold.empty()) {
    text += "; not told, for want of people, of repeated recordings or of a spread: " + untold;
  }
  return text + "\n";
}

}  // namespace

TextTable ContrastTable(const Contrast& c) {
  TextTable table({"parameter", c.first, c.second, "difference", "95 % interval", "unit",
                   "effect, sd", "p", "Holm's p", "status"},
                  {true, false, false, false, true, true, false, false, false, true});
  for (const ContrastRow& row : c.rows) {
    table.Add({row.name, Rounded(row.first, 4), Rounded(row.second, 4), Rounded(row.difference, 3),
               IntervalText(row.difference, row.lower95, row.upper95), row.unit,
               row.effect ? Rounded(*row.effect, 2) : "-", ProbabilityText(row.p),
               ProbabilityText(row.p_holm), NameOf(row.status)});
  }
  return table;
}

std::string ContrastText(const FitResult& result) {
  if (!result.contrast) return "";
  return ComparedText(*result.contrast) + "\n" + DifferText(*result.contrast) + "\n" +
         EffectNote(result);
}

}  // namespace pushid
