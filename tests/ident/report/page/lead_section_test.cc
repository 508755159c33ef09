// The report's three sentences, by hand.
#include <gtest/gtest.h>

#include "ident/report/page/sections.h"
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

TEST(LeadSection, SaysWhatIsKnownWhatIsNotAndWhatToDo) {
  FittedModel model;
  model.fit.estimates = {EstimateOf("mu", 31.25, EstimateStatus::kIdentified),
                         EstimateOf("Kp_x", 0.0, EstimateStatus::kFixed),
                         EstimateOf("a_x", -10.0, EstimateStatus::kPriorHeld),
                         EstimateOf("a_y", -9.0, EstimateStatus::kWeak)};
  model.fit.behaviour.settles = true;
  model.fit.uncertainty.clustered = true;
  model.fit.uncertainty.num_clusters = 4;
  model.fit.uncertainty.clustered_by = ClusterBy::kSubject;
  model.advice = {{"Record more people.", "pushid-fit"}};
  const ReportSection section = LeadSection(model);
  ASSERT_EQ(section.paragraphs.size(), 3u);
  EXPECT_TRUE(
      Contains(section.paragraphs[0], "What is known: these recordings decide mu = 31.25 N s/m"));
  EXPECT_TRUE(Contains(section.paragraphs[0], "the fitted person settles within 2 s"));
  EXPECT_EQ(section.paragraphs[1],
            "What is not: decided more by what was put in than by the recordings: a_x; with wide "
            "intervals: a_y; with 4 people every interval is a rough guess.");
  EXPECT_EQ(section.paragraphs[2], "What to do next: Record more people.");
}

TEST(LeadSection, ManyNamesAreCounted) {
  FittedModel model;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    model.fit.estimates.push_back(EstimateOf(name, 1.0, EstimateStatus::kWeak));
  }
  EXPECT_TRUE(Contains(LeadSection(model).paragraphs[1], "wide intervals: a, b, c, d and 2 more"));
  EXPECT_TRUE(Contains(LeadSection(model).paragraphs[0], "no parameter is decided"));
}

}  // namespace
}  // namespace pushid
