// ident: the table of a design, and its heading.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/files/number_text.h"
#include "ident/report/report_text.h"

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
  return TextTable::OfNumbers(header);
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

namespace {

std::vector<size_t> Chosen(const StudyPlan& plan, const std::string& parameter) {
  std::vector<size_t> chosen;
  for (size_t i = 0; i < plan.parameters.size(); ++i) {
    if (parameter == "all" || plan.parameters[i] == parameter) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

TextTable SensorTable(const StudyPlan& plan, const std::string& parameter) {
  TextTable table = TextTable::OfNumbers({"with the force measured", "its error"});
  if (plan.sensor_ratio.empty()) return table;
  for (size_t i : Chosen(plan, parameter)) {
    const double ratio = plan.sensor_ratio[i];
    // Pooled recordings that differ may even scatter more: no promise then.
    std::string change = ratio < 1.0 ? Rounded(100.0 * (ratio - 1.0), 2) + " %" : "no gain found";
    if (std::isnan(ratio)) change = "not needed any more";
    table.Add({plan.parameters[i], change});
  }
  return table;
}

TextTable StudySizesTable(const StudyPlan& plan, const std::string& parameter) {
  const std::vector<size_t> chosen = Chosen(plan, parameter);
  std::vector<std::string> header = {"people", "pushes of each"};
  for (size_t i : chosen) {
    header.push_back("error of " + WithUnit(plan.parameters[i], plan.units[i]));
  }
  TextTable table(header, std::vector<bool>(header.size(), false));
  for (const StudySize& size : plan.sizes) {
    std::vector<std::string> cells = {std::to_string(size.people), Rounded(size.pushes, 3)};
    for (size_t i : chosen) cells.push_back(Rounded(size.standard_error[i], 3));
    table.Add(cells);
  }
  return table;
}

std::string StudySizesNote(const StudyPlan& plan) {
  if (plan.sizes.empty()) return "";
  const int people = plan.sizes.front().people;
  return "The variation between people is estimated from " + std::to_string(people) +
         " of them, with an accuracy of about " +
         Rounded(100.0 / std::sqrt(2.0 * (people - 1)), 2) +
         " %; the same holds for these standard errors.";
}

std::string NoSensorText(const StudyPlan& plan) {
  return plan.no_sensor.empty() ? "" : "No force sensor is proposed: " + plan.no_sensor + ".";
}

std::string NoSizesText(const StudyPlan& plan) {
  return plan.no_sizes.empty() ? "" : "More people, more pushes: " + plan.no_sizes + ".";
}

TextTable EquipmentTable(const StudyPlan& plan, const std::string& parameter) {
  const std::vector<size_t> chosen = Chosen(plan, parameter);
  std::vector<std::string> header = {"equipment"};
  for (size_t i : chosen) header.push_back("error of " + plan.parameters[i]);
  TextTable table = TextTable::OfNumbers(header);
  for (const EquipmentRow& row : plan.equipment) {
    std::vector<std::string> cells = {row.equipment};
    for (size_t i : chosen) cells.push_back(Change(row.error_ratio[i]));
    table.Add(cells);
  }
  return table;
}

std::string StudiesText(const StudyPlan& plan, const std::string& parameter) {
  std::string text = NoSensorText(plan);
  text += text.empty() ? "effect of a force sensor in the same study, with the whole push known\n" +
                             SensorTable(plan, parameter).ToString()
                       : "\n";
  if (!plan.equipment.empty()) {
    text += "\neffect of a laboratory's equipment on standard errors\n" +
            EquipmentTable(plan, parameter).ToString();
  }
  if (!plan.no_sizes.empty()) return text + "\n" + NoSizesText(plan) + "\n";
  text += "\nstandard errors with more people and more pushes of each\n" +
          StudySizesTable(plan, parameter).ToString();
  TextTable spread = TextTable::OfNumbers(
      {"standard deviation", "between people", "added by each push", "noise of one push"});
  for (size_t i : Chosen(plan, parameter)) {
    spread.Add({WithUnit(plan.parameters[i], plan.units[i]), Rounded(plan.between_people[i], 3),
                Rounded(plan.between_recordings[i], 3), Rounded(plan.noise[i], 3)});
  }
  return text + spread.ToString() + StudySizesNote(plan) + "\n";
}

}  // namespace pushid
