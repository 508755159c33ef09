// ident: the table of a design, and its heading.
#include "ident/report/design_text.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/report/studies_text.h"

namespace pushid {
namespace {

constexpr int kRows = 10;

std::string DirectionText(double degrees) {
  if (degrees == 0.0) return "forwards";
  if (degrees == 90.0) return "to the left";
  if (degrees == 180.0) return "backwards";
  return Rounded(degrees, 4) + " degrees left";
}

std::string Change(double ratio) { return Rounded(100.0 * (ratio - 1.0), 2) + " %"; }

// Where the parameter stands among those with an error; nothing for "all".
std::optional<size_t> IndexOf(const ExperimentDesign& design, const std::string& parameter) {
  if (parameter == "all") return std::nullopt;
  const auto at = std::find(design.parameters.begin(), design.parameters.end(), parameter);
  return static_cast<size_t>(at - design.parameters.begin());
}

TextTable EmptyTable(const std::optional<size_t>& index, const std::string& parameter) {
  std::vector<std::string> header = {"one more push", "m/s^2", "height", "s", "kg"};
  if (index) header.push_back("error of " + parameter);
  header.push_back("mean of all errors");
  std::vector<bool> left(header.size(), false);
  left[0] = true;
  return TextTable(header, left);
}

std::vector<std::string> Cells(const DesignRow& row, const std::optional<size_t>& index) {
  std::vector<std::string> cells = {DirectionText(row.push.direction_deg),
                                    Rounded(row.push.acceleration, 3), Rounded(row.push.height, 2),
                                    Rounded(row.push.duration_s, 2), Rounded(row.push.mass_kg, 3)};
  if (index) cells.push_back(Change(row.error_ratio[*index]));
  cells.push_back(Change(row.volume_ratio));
  return cells;
}

}  // namespace

Result<TextTable> DesignTable(const ExperimentDesign& design, const std::string& parameter,
                              int count) {
  const Result<std::vector<DesignRow>> ranked = RankedRows(design, parameter);
  if (!ranked.ok()) return ranked.error();
  const std::vector<DesignRow>& rows = ranked.value();
  const std::optional<size_t> index = IndexOf(design, parameter);
  TextTable table = EmptyTable(index, parameter);
  const size_t shown = std::min(rows.size(), static_cast<size_t>(count));
  for (size_t i = 0; i < shown; ++i) table.Add(Cells(rows[i], index));
  if (rows.size() > shown) {
    table.AddGap();
    table.Add(Cells(rows.back(), index));
  }
  return table;
}

Result<std::string> DesignText(const ExperimentDesign& design, const std::string& parameter) {
  if (!design.refused.empty()) {
    return "no further push is proposed: " + design.refused + "\n\n" +
           StudiesText(design.studies, parameter);
  }
  const Result<TextTable> table = DesignTable(design, parameter, kRows);
  if (!table.ok()) return table.error();
  std::string text = "effect of one more recording, best first; last row: the least useful of " +
                     std::to_string(design.rows.size()) + " candidates\n" +
                     table.value().ToString();
  if (const std::optional<size_t> index = IndexOf(design, parameter)) {
    text += "now: " + parameter + " +- " + Rounded(design.standard_error[*index], 3) + " " +
            design.units[*index] + "\n";
  }
  return text + "\n" + StudiesText(design.studies, parameter);
}

}  // namespace pushid
