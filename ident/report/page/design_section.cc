// ident: the next push to record, as a section of the page.
#include "ident/figures/text_table.h"
#include "ident/report/design_text.h"
#include "ident/report/page/sections.h"
#include "ident/report/studies_text.h"

namespace pushid {
namespace {

constexpr int kBestPushes = 8;

// The best pushes to record next, over all and for each parameter.
void AddPushes(const ExperimentDesign& design, ReportSection* section) {
  section->paragraphs.push_back(
      "Effect of one more recording of each kind on the standard errors, from the sensitivities at "
      "the estimate: for all parameters together (D-optimal) and for each (c-optimal).");
  section->tables.push_back(
      {"for all parameters", DesignTable(design, "all", kBestPushes).value()});
  TextTable best({"parameter", "best push", "m/s^2", "height", "s", "kg", "its error"},
                 {true, true, false, false, false, false, false});
  for (const std::string& parameter : design.parameters) {
    // Its first row under the header: direction, strength, height, duration, mass, error.
    std::vector<std::string> row = DesignTable(design, parameter, 1).value().rows()[1];
    row.insert(row.begin(), parameter);
    row.resize(best.rows()[0].size());
    best.Add(row);
  }
  section->tables.push_back({"for each parameter", best});
}

// What a force sensor and more people would tell.
void AddStudies(const StudyPlan& plan, ReportSection* section) {
  if (plan.no_sensor.empty()) {
    section->tables.push_back(
        {"a force sensor: the same study with the whole push known", SensorTable(plan, "all")});
  } else {
    section->paragraphs.push_back("No force sensor is proposed: " + plan.no_sensor + ".");
  }
  if (plan.sizes.empty()) {
    section->paragraphs.push_back("More people, more pushes: " + plan.no_sizes + ".");
    return;
  }
  section->paragraphs.push_back(StudySizesNote(plan));
  section->tables.push_back(
      {"standard errors with more people and more pushes of each (first row: this study)",
       StudySizesTable(plan, "all")});
}

}  // namespace

ReportSection DesignSection(const ExperimentDesign& design) {
  ReportSection section{"design", "What to record next", {}, {}, {}, {}, {}, ""};
  if (!design.refused.empty()) section.paragraphs = {"Left out: " + design.refused + "."};
  if (!design.rows.empty()) AddPushes(design, &section);
  AddStudies(design.studies, &section);
  return section;
}

}  // namespace pushid
