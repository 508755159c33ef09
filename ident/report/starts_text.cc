// ident: the spread of a multi-start.
#include "ident/report/starts_text.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

bool Ended(const SolveStart& start) { return start.usable && start.failed.empty(); }

// A likelihood's cost is known but for a constant: its differences count, not its shares.
constexpr double kSameLogLikelihood = 0.5;

bool OfLikelihood(const FitResult& result) {
  return result.options.likelihood != Likelihood::kTrajectory;
}

std::vector<const SolveStart*> AsGood(const FitResult& result) {
  std::vector<const SolveStart*> as_good;
  const double same = OfLikelihood(result) ? kSameLogLikelihood : kSameCost * result.cost;
  for (const SolveStart& start : result.starts) {
    if (Ended(start) && start.cost <= result.cost + same) as_good.push_back(&start);
  }
  return as_good;
}

}  // namespace

std::string AcrossStartsNote(const FitResult& result) {
  if (result.starts.size() < 2) return "";
  double worst = result.cost;
  for (const SolveStart& start : result.starts) {
    if (Ended(start)) worst = std::max(worst, start.cost);
  }
  return std::to_string(AsGood(result).size()) + " of " + std::to_string(result.starts.size()) +
         " starts end within " + (OfLikelihood(result) ? "0.5" : "1 %") + " of the lowest cost, " +
         Rounded(result.cost, 6) + "; the highest is " + Rounded(worst, 6) + "\n";
}

TextTable AcrossStartsTable(const FitResult& result) {
  TextTable table({"across these starts", "lowest", "highest", "unit", "in standard errors"},
                  {true, false, false, true, false});
  const std::vector<const SolveStart*> as_good = AsGood(result);
  if (result.starts.size() < 2 || as_good.empty()) return table;
  size_t index = 0;
  for (Parameter id : result.options.table.Free()) {
    const ParameterSpec& spec = result.options.table[id];
    double low = INFINITY, high = -INFINITY;
    for (const SolveStart* start : as_good) {
      const double value = ToNatural(spec.transform, start->to.shared[index]);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const auto estimate = std::find_if(result.estimates.begin(), result.estimates.end(),
                                       [&spec](const Estimate& e) { return e.name == spec.name; });
    const bool known = estimate != result.estimates.end() && estimate->standard_error > 0.0;
    table.Add({spec.name, Rounded(low, 4), Rounded(high, 4), spec.unit,
               known ? Rounded((high - low) / estimate->standard_error, 2) : "-"});
    ++index;
  }
  return table;
}

std::string AcrossStartsText(const FitResult& result) {
  const TextTable table = AcrossStartsTable(result);
  return AcrossStartsNote(result) + (table.rows().size() > 1 ? table.ToString() : "");
}

}  // namespace pushid
