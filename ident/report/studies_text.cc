// ident: the tables of a study's plan.
#include "ident/report/studies_text.h"

#include <cmath>
#include <vector>

#include "datasets/files/number_text.h"

namespace pushid {
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
  TextTable table({"with the force measured", "its error"}, {true, false});
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

std::string StudiesText(const StudyPlan& plan, const std::string& parameter) {
  std::string text;
  if (plan.no_sensor.empty()) {
    text += "effect of a force sensor in the same study, with the whole push known\n" +
            SensorTable(plan, parameter).ToString();
  } else {
    text += "no force sensor is proposed: " + plan.no_sensor + "\n";
  }
  if (!plan.no_sizes.empty()) return text + "\nmore people, more pushes: " + plan.no_sizes + "\n";
  text += "\nstandard errors with more people and more pushes of each\n" +
          StudySizesTable(plan, parameter).ToString();
  TextTable spread(
      {"standard deviation", "between people", "added by each push", "noise of one push"},
      {true, false, false, false});
  for (size_t i : Chosen(plan, parameter)) {
    spread.Add({WithUnit(plan.parameters[i], plan.units[i]), Rounded(plan.between_people[i], 3),
                Rounded(plan.between_recordings[i], 3), Rounded(plan.noise[i], 3)});
  }
  return text + spread.ToString() + StudySizesNote(plan) + "\n";
}

}  // namespace pushid
