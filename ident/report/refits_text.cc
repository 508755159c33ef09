// ident: refits beside the fit.
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/push/push_check.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/refit_checks.h"

namespace pushid {
namespace {

constexpr double kFarMove = 2.0;  // standard errors

std::string ValueText(double value, double error) {
  return Rounded(value, 4) + " +- " + Rounded(error, 2);
}

// A row a parameter, a column a refit, and the fit itself last.
TextTable FitAndRefits(const RefitTable& check, const std::string& refits, const std::string& fit,
                       bool with_errors) {
  std::vector<std::string> header = {refits};
  for (const RefitRow& row : check.rows) header.push_back(row.name);
  header.insert(header.end(), {fit, "unit"});
  TextTable table(header);
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    std::vector<std::string> cells = {check.parameters[i]};
    for (const RefitRow& row : check.rows) {
      cells.push_back(row.value.empty() ? "-"
                      : with_errors     ? ValueText(row.value[i], row.standard_error[i])
                                        : Rounded(row.value[i], 4));
    }
    cells.push_back(ValueText(check.value[i], check.standard_error[i]));
    cells.push_back(check.units[i]);
    table.Add(cells);
  }
  return table;
}

std::string FailuresText(const RefitTable& check) {
  std::string text;
  for (const RefitRow& row : check.rows) {
    if (!row.failure.empty()) text += row.source + " " + row.name + ": " + row.failure + "\n";
  }
  return text;
}

}  // namespace

std::string SameWindowText(const RefitTable& check) {
  for (const RefitRow& row : check.rows) {
    if (row.name != kSameWindow || row.value.empty()) continue;
    for (size_t i = 0; i < check.parameters.size(); ++i) {
      const double errors = std::abs(row.value[i] - check.value[i]) / check.standard_error[i];
      if (!(errors > kFarMove)) continue;
      return "even the same window moves " + check.parameters[i] + " by " + Rounded(errors, 2) +
             " standard errors: inverse dynamics cannot reproduce these pushes, so what other "
             "windows do says nothing of their errors\n";
    }
  }
  return "";
}

namespace {

// Which parameters other priors move by more than twice their error.
std::string PriorVerdict(const RefitTable& check) {
  std::string moved;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    double most = 0.0;
    for (const RefitRow& row : check.rows) {
      if (!row.value.empty()) most = std::max(most, std::abs(row.value[i] - check.value[i]));
    }
    if (check.standard_error[i] <= 0.0) continue;  // at its bound
    if (!(most > kFarMove * check.standard_error[i])) continue;
    moved += (moved.empty() ? "" : ", ") + check.parameters[i];
  }
  return moved.empty()
             ? "no parameter moves by more than twice its error\n"
             : "determined by priors, as they move by more than twice their errors: " + moved +
                   "\n";
}

}  // namespace

TextTable PushErrorTable(const RefitTable& check) {
  TextTable table({"pushes", "value", "standard error", "push error", "total error", "unit"},
                  {true, false, false, false, false, true});
  const std::vector<PushError> errors = PushErrors(check);
  const bool valid = SameWindowText(check).empty();
  for (size_t i = 0; i < errors.size(); ++i) {
    table.Add({check.parameters[i], Rounded(check.value[i], 4), Rounded(check.standard_error[i], 3),
               valid ? Rounded(errors[i].push, 3) : "-", valid ? Rounded(errors[i].total, 3) : "-",
               check.units[i]});
  }
  return table;
}

TextTable MovesTable(const RefitTable& check) {
  std::vector<std::string> header = {"source", "push"};
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    header.push_back(WithUnit(check.parameters[i], check.units[i]));
  }
  std::vector<bool> left(header.size(), false);
  left[0] = left[1] = true;
  TextTable table(header, left);
  for (const RefitRow& row : check.rows) {
    std::vector<std::string> cells = {row.source, row.name};
    for (size_t i = 0; i < check.parameters.size(); ++i) {
      if (row.value.empty()) {
        cells.push_back("-");
        continue;
      }
      const double move = row.value[i] - check.value[i];
      cells.push_back((move < 0.0 ? "" : "+") + Rounded(move, 3));
    }
    table.Add(cells);
  }
  return table;
}

TextTable HorizonTable(const RefitTable& check) {
  return FitAndRefits(check, "from the push on", "all", true);
}

TextTable PriorTable(const RefitTable& check) {
  return FitAndRefits(check, "priors", "as fitted", false);
}

namespace {

std::string SingleStepsText(const RefitTable& check) {
  std::string names;
  for (const Drift& move : MovesOfSingleSteps(check)) {
    names += (names.empty() ? "" : ", ") + check.parameters[move.parameter];
  }
  if (names.empty()) return "";
  return "single steps give other values of " + names +
         " (more than two standard errors apart): noise of the joints does that too, so it does "
         "not show that the model omits something\n";
}

}  // namespace

std::string DriftText(const RefitTable& check) {
  std::string text;
  for (const Drift& drift : Drifts(check)) {
    const RefitRow& row = check.rows[drift.row];
    text += check.parameters[drift.parameter] + " drifts: " +
            ValueText(row.value[drift.parameter], row.standard_error[drift.parameter]) +
            " in the first " + row.name + " of the push, " +
            ValueText(check.value[drift.parameter], check.standard_error[drift.parameter]) +
            " in all, " + Rounded(drift.in_errors, 2) +
            " standard errors apart; it compensates for something that the model omits\n";
  }
  return (text.empty() ? "no parameter drifts by more than twice its error\n" : text) +
         SingleStepsText(check);
}

std::string HorizonClaims(const RefitTable& check) {
  if (check.rows.empty() || check.rows[0].frames != kOneStep) return "";
  return "one step: the response from one frame to the next, for controllers and filters\n"
         "8 frames, 16 frames, ...: counted from the start of the push, for predictions that far\n"
         "all: the motion over whole recordings, for predictions from the push and for "
         "simulations\n";
}

std::string PushCheckText(const RefitTable& check) {
  return SameWindowText(check) + PushErrorTable(check).ToString() +
         "total error: includes the uncertainty of the pushes; change in each refit:\n" +
         MovesTable(check).ToString() + FailuresText(check);
}

std::string PriorCheckText(const RefitTable& check) {
  if (check.rows.empty()) return "no free parameter has a prior\n";
  return PriorTable(check).ToString() +
         "refits with means and widths of all priors halved and doubled\n" + PriorVerdict(check) +
         FailuresText(check);
}

std::string HorizonCheckText(const RefitTable& check) {
  if (check.rows.empty())
    return "no recording goes on for longer after its push than the shortest horizon\n";
  return HorizonTable(check).ToString() + DriftText(check) + HorizonClaims(check) +
         FailuresText(check);
}

}  // namespace pushid
