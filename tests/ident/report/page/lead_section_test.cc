// The first section of the page, by hand.
#include <gtest/gtest.h>

#include "datasets/files/names.h"
#include "ident/parameters/parameter_table.h"
#include "ident/report/document.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Estimate EstimateOf(const std::string& name, double value, EstimateStatus status) {
  Estimate e;
  e.name = name;
  e.unit = "N s/m";
  e.value = value;
  e.status = status;
  return e;
}

ReportSection SectionOf(const FittedModel& model, const PropagationSummary& propagation) {
  return LeadSection({model, model.fit, {}, propagation});
}

TEST(LeadSection, SaysWhatIsFoundAndWhatToDo) {
  FittedModel model;
  model.fit.options.table = BaseTable();
  model.fit.estimates = {EstimateOf("mu", 31.25, EstimateStatus::kIdentified),
                         EstimateOf("Kp_x", 0.0, EstimateStatus::kFixed),
                         EstimateOf("a_y", -9.0, EstimateStatus::kWeak)};
  model.fit.estimates[0].standard_error = 5.0;
  model.fit.estimates[0].lower95 = 20.0;
  model.fit.estimates[0].upper95 = 42.0;
  model.fit.behaviour.settles = true;
  model.advice = {{"Record more people.", "pushid-fit"}};
  const ReportSection section = SectionOf(model, {});
  const std::string page = ToPage({"title", "", {section}});
  EXPECT_LT(page.find("The model was not checked"), page.find("<figure"));
  EXPECT_EQ(section.paragraphs.front(), "The model was not checked: an older version fitted.");
  EXPECT_TRUE(Contains(page, "What to do next: Record more people."));
  const auto& rows = section.tables.at(0).table.rows();
  ASSERT_EQ(rows.size(), 3u) << "what is fixed has no row";
  EXPECT_EQ(rows[1], (std::vector<std::string>{"mu", "31.2", "[20, 42]", "N s/m", "identified"}));
}

TEST(LeadSection, SaysHowThePushTravels) {
  PropagationSummary travels;
  travels.recordings = 4;  // in one of which too few moved
  travels.movers = 9.0;
  travels.missed_movers = 2.0;
  travels.figures[kSlownessMeasured] = {0.5, 0.1, 3.0};
  travels.figures[kSlownessPredicted] = {0.25, 0.0, 9.0};
  const ReportSection section = SectionOf(FittedModel(), travels);
  EXPECT_TRUE(
      Contains(Joined(section.paragraphs, "\n"),
               "How the push travels in the fitted recordings: in 3 recordings the onset of motion "
               "propagated "
               "at 2 +- 0.4 m/s (predicted: 4); the model misses 2 of the 9 people who moved."));
}

TEST(LeadSection, SaysWhatIsUndeterminedAndTheGains) {
  FittedModel model;
  model.fit.estimates = {EstimateOf("Kp_theta", 2340.0, EstimateStatus::kWeak)};
  model.fit.estimates[0].standard_error = 1e3;
  model.fit.estimates[0].lower95 = 6.6e-8;
  model.fit.estimates[0].upper95 = 8.3e13;
  model.fit.derived = {{"Kp_theta/(m g l)", "1", 1.6, 0.1, 1.4, 1.8}};
  const ReportSection section = SectionOf(model, {});
  EXPECT_EQ(section.tables.at(0).table.rows()[1][2], "undetermined");
  EXPECT_TRUE(Contains(Joined(section.paragraphs), "Ankle stiffness 1.6 times m g l"));
}

TEST(LeadSection, OfManyTheIdentifiedComeFirst) {
  FittedModel model;
  for (int i = 0; i < 12; ++i) {
    model.fit.estimates.push_back(EstimateOf("p" + std::to_string(i), 1.0,
                                             i == 11 ? EstimateStatus::kIdentified
                                             : i < 2 ? EstimateStatus::kPriorHeld
                                                     : EstimateStatus::kWeak));
  }
  const TextTable table = ShortTable(model.fit);
  EXPECT_EQ(table.rows()[1][0], "p11");
  EXPECT_EQ(table.rows()[2][0], "p2");
  EXPECT_EQ(table.rows()[12][0], "p1");
}

}  // namespace
}  // namespace pushid
