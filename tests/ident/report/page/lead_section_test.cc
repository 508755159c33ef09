// The report's three sentences, by hand.
#include <gtest/gtest.h>

#include "ident/parameters/parameter_table.h"
#include "ident/report/document.h"
#include "ident/report/page/motion_sections.h"
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

TEST(LeadSection, SaysWhatIsKnownWhatIsNotAndWhatToDo) {
  FittedModel model;
  model.fit.options.table = BaseTable();
  model.fit.estimates = {EstimateOf("mu", 31.25, EstimateStatus::kIdentified),
                         EstimateOf("Kp_x", 0.0, EstimateStatus::kFixed),
                         EstimateOf("a_x", -10.0, EstimateStatus::kPriorHeld),
                         EstimateOf("a_y", -9.0, EstimateStatus::kWeak)};
  model.fit.estimates[0].lower95 = 20.0;
  model.fit.estimates[0].upper95 = 42.0;
  model.fit.behaviour.settles = true;
  model.fit.uncertainty.clustered = true;
  model.fit.uncertainty.num_clusters = 4;
  model.fit.uncertainty.clustered_by = ClusterBy::kSubject;
  model.advice = {{"Record more people.", "pushid-fit"}};
  const ReportSection section = SectionOf(model, {});
  ASSERT_EQ(section.paragraphs.size(), 4u);
  const std::string page = ToPage({"title", "", {section}});
  EXPECT_LT(page.find("The model was not checked"), page.find("<figure"));
  EXPECT_EQ(section.paragraphs[0], "The model was not checked: an older version fitted.");
  EXPECT_TRUE(Contains(section.paragraphs[2],
                       "What is known: these recordings identify mu = 31.2 N s/m (20 to 42)"));
  EXPECT_TRUE(Contains(section.paragraphs[2], "the fitted person settles within 2 s"));
  EXPECT_EQ(
      section.paragraphs[3],
      "What is not known: determined more by priors or constraints than by the recordings: a_x = "
      "-10 N s/m; with wide intervals: a_y = -9 N s/m; with 4 people all intervals are rough.");
  EXPECT_EQ(section.paragraphs[1], "What to do next: Record more people.");
  ASSERT_EQ(section.figures.size(), 1u);
  EXPECT_EQ(section.figures[0].figure.panels.size(), 1u) << "only what is identified";
}

TEST(LeadSection, SaysHowThePushTravels) {
  PropagationSummary travels;
  travels.recordings = 4;  // in one of which too few moved
  travels.movers = 9.0;
  travels.missed_movers = 2.0;
  travels.figures[kSlownessMeasured] = {0.5, 0.1, 3.0};
  travels.figures[kSlownessPredicted] = {0.25, 0.0, 9.0};
  const ReportSection section = SectionOf(FittedModel(), travels);
  ASSERT_EQ(section.paragraphs.size(), 5u);
  EXPECT_EQ(section.paragraphs[4],
            "How the push travels in the fitted recordings: in 3 recordings the onset of motion "
            "propagated "
            "at 2 +- 0.4 m/s (predicted: 4); the model misses 2 of the 9 people who moved.");
}

TEST(LeadSection, SaysWhatIsUndeterminedAndTheGains) {
  FittedModel model;
  model.fit.estimates = {EstimateOf("Kp_theta", 2340.0, EstimateStatus::kWeak)};
  model.fit.estimates[0].lower95 = 6.6e-8;
  model.fit.estimates[0].upper95 = 8.3e13;
  model.fit.derived = {{"Kp_theta/(m g l)", "1", 1.6, 0.1, 1.4, 1.8}};
  const ReportSection section = SectionOf(model, {});
  ASSERT_EQ(section.paragraphs.size(), 5u);
  EXPECT_TRUE(Contains(section.paragraphs[3], "Kp_theta = 2340 N s/m (undetermined)"));
  EXPECT_TRUE(Contains(section.paragraphs[4], "Ankle stiffness 1.6 times m g l"));
}

TEST(LeadSection, ManyNamesAreCounted) {
  FittedModel model;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    model.fit.estimates.push_back(EstimateOf(name, 1.0, EstimateStatus::kWeak));
  }
  EXPECT_TRUE(Contains(SectionOf(model, {}).paragraphs[3],
                       "a = 1 N s/m, b = 1 N s/m, c = 1 N s/m, d = 1 N s/m and 2 more"));
  EXPECT_TRUE(Contains(SectionOf(model, {}).paragraphs[2], "identify no parameter"));
}

}  // namespace
}  // namespace pushid
