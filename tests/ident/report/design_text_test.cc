// The table of a design: best first, with its units, and the least useful one last.
#include <gtest/gtest.h>

#include "ident/report/report_text.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Three pushes and two parameters: forwards tells most about mu, to the left most about mu_y.
ExperimentDesign SmallDesign() {
  ExperimentDesign design;
  design.parameters = {"mu", "mu_y"};
  design.units = {"N s/m", "N s/m"};
  design.standard_error = {4.0, 8.0};
  design.rows = {{{0.0, 3.0, 1.0, 0.1, 80.0}, {0.7, 1.0}, 0.85},
                 {{90.0, 3.0, 1.0, 0.1, 80.0}, {1.0, 0.5}, 0.75},
                 {{180.0, 2.0, 0.8, 0.1, 80.0}, {0.9, 0.98}, 0.95}};
  return design;
}

TEST(DesignTextTest, BestFirstForTheParameterAsked) {
  const TextTable of_mu = DesignTable(SmallDesign(), "mu", 3).value();
  ASSERT_EQ(of_mu.rows().size(), 4u);  // with the header
  EXPECT_EQ(of_mu.rows()[1][0], "forwards");
  EXPECT_EQ(of_mu.rows()[1][5], "-30 %");
  EXPECT_EQ(of_mu.rows()[3][0], "to the left");
  const TextTable of_all = DesignTable(SmallDesign(), "all", 3).value();
  EXPECT_EQ(of_all.rows()[1][0], "to the left");
  EXPECT_EQ(of_all.rows()[1].size(), 6u) << "no column of one parameter";
}

TEST(DesignTextTest, TheLeastUsefulOneStandsLast) {
  const std::string table = DesignTable(SmallDesign(), "mu_y", 1).value().ToString();
  EXPECT_LT(table.find("to the left"), table.find("forwards"));
  EXPECT_FALSE(Contains(table, "backwards")) << table;
}

TEST(DesignTextTest, SaysThePresentErrorWithItsUnit) {
  const std::string text = DesignText(SmallDesign(), "mu_y").value();
  EXPECT_TRUE(Contains(text, "error of mu_y")) << text;
  EXPECT_TRUE(Contains(text, "now: mu_y +- 8 N s/m\n")) << text;
  EXPECT_FALSE(Contains(DesignText(SmallDesign(), "all").value(), "now:"));
}

TEST(DesignTextTest, AnUnknownParameterIsToldWhatThereIs) {
  EXPECT_TRUE(Contains(ProblemOf(DesignText(SmallDesign(), "nu")), "all, mu, mu_y"));
}

TEST(DesignTextTest, ARefusedDesignSaysWhy) {
  ExperimentDesign refused;
  refused.refused = "too few recordings";
  ASSERT_FALSE(DesignTable(refused, "all", 5).ok());
  EXPECT_EQ(DesignTable(refused, "all", 5).error().message, "too few recordings");
}

}  // namespace
}  // namespace pushid
