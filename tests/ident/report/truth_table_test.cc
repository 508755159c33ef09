// The truth beside the estimates: what is compared, and what counts as covered.
#include <gtest/gtest.h>

#include <limits>

#include "ident/report/parameter_sections.h"
#include "ident/report/report_text.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Estimate Estimated(const std::string& name, double value, double lower, double upper) {
  Estimate e;
  e.name = name;
  e.unit = "N";
  e.value = value;
  e.standard_error = 0.25 * (upper - lower);
  e.lower95 = lower;
  e.upper95 = upper;
  e.status = EstimateStatus::kIdentified;
  return e;
}

// The line of the table that starts with `name`.
std::string Line(const std::string& table, const std::string& name) {
  const size_t begin = table.find(name);
  return begin == std::string::npos ? "" : table.substr(begin, table.find('\n', begin) - begin);
}

TEST(TruthTable, SaysWhichIntervalsCoverTheTruth) {
  FitResult result;
  result.estimates = {Estimated("inside", 2.0, 1.0, 3.0), Estimated("below", 2.0, 1.0, 3.0),
                      Estimated("above", 2.0, 1.0, 3.0)};
  const std::string table =
      TruthTable(result, {{"inside", 1.5}, {"below", 0.999}, {"above", 3.001}});
  EXPECT_TRUE(Contains(Line(table, "inside"), "covers"));
  EXPECT_TRUE(Contains(Line(table, "inside"), "[1, 3]"));
  EXPECT_TRUE(Contains(Line(table, "below"), "misses"));
  EXPECT_TRUE(Contains(Line(table, "above"), "misses"));
  EXPECT_TRUE(Contains(table, "1 of 3 intervals"));
}

TEST(TruthTable, TheIntervalIsTheOneThatDecides) {
  FitResult result;
  result.estimates = {Estimated("mu", 2.0, 1.0, 3.0)};
  EXPECT_TRUE(Contains(TruthTable(result, {{"mu", 4.0}}), "0 of 1 intervals"));
  result.estimates[0].total = Interval{1.0, 0.0, 5.0};
  const std::string table = TruthTable(result, {{"mu", 4.0}});
  EXPECT_TRUE(Contains(Line(table, "mu"), "[0, 5]"));
  EXPECT_TRUE(Contains(table, "1 of 1 intervals cover the truth"));
}

TEST(TruthTable, LeavesOutWhatWasNotFittedOrIsNotKnown) {
  FitResult result;
  result.estimates = {Estimated("fitted", 2.0, 1.0, 3.0), Estimated("held", 2.0, 1.0, 3.0),
                      Estimated("unknown", 2.0, 1.0, 3.0)};
  result.estimates[1].status = EstimateStatus::kFixed;
  const std::string table = TruthTable(result, {{"fitted", 2.0}, {"held", 2.0}});
  EXPECT_EQ(Line(table, "held"), "");
  EXPECT_EQ(Line(table, "unknown"), "");
  EXPECT_TRUE(Contains(table, "1 of 1 intervals"));
}

TEST(TruthTable, RoundingInTheFilesIsNoMiss) {
  FitResult result;
  result.estimates = {Estimated("exact", -9.2 + 1e-8, -9.2 + 0.9e-8, -9.2 + 1.1e-8)};
  EXPECT_TRUE(Contains(TruthTable(result, {{"exact", -9.2}}), "1 of 1 intervals"));
}

// An unidentifiable parameter has an interval without end: it covers, and NaN never does.
TEST(TruthTable, EndlessIntervalsCoverAndUndefinedOnesDoNot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  FitResult result;
  result.estimates = {Estimated("endless", 2.0, -kInfinity, kInfinity),
                      Estimated("undefined", 2.0, kNan, kNan)};
  const std::string table = TruthTable(result, {{"endless", 5.0}, {"undefined", 2.0}});
  EXPECT_TRUE(Contains(Line(table, "endless"), "covers"));
  EXPECT_TRUE(Contains(Line(table, "undefined"), "misses"));
}

using ReadTruthTest = TempDirTest;

TEST_F(ReadTruthTest, ReadsTheValuesByName) {
  const std::string path =
      WriteText("manifest.json", R"({"synthetic": {"truth": {"mu": 28.9, "a_x": -9.2}}})");
  const auto truth = Unwrapped(ReadTruth(path));
  EXPECT_EQ(truth, (std::map<std::string, double>{{"a_x", -9.2}, {"mu", 28.9}}));
}

TEST_F(ReadTruthTest, RealRecordingsHaveNone) {
  for (const char* text : {R"({"recordings": []})", R"({"synthetic": 3})",
                           R"({"synthetic": {"truth": {"mu": "x"}}})", R"([1])"}) {
    EXPECT_TRUE(Contains(ProblemOf(ReadTruth(WriteText("manifest.json", text))), "manifest.json"));
  }
  EXPECT_FALSE(ReadTruth(Path("none.json")).ok());
}

}  // namespace
}  // namespace pushid
