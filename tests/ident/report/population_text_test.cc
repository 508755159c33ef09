// What is said of the effects of recordings.
#include <gtest/gtest.h>

#include "ident/report/report_text.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

RecordingEffect Sample() {
  RecordingEffect effect;
  effect.spread = 0.43;
  effect.spread_error = 0.061;
  effect.error_scale = 0.116;
  effect.explained = 0.38;
  effect.clusters = 4;
  effect.recordings = {{"r2", "B", "p", 0.3, 0.1, 0.36},
                       {"r1", "A", "p", 0.2, 0.2, 0.4},
                       {"r0", "A", "m", -0.1, 0.1, -0.12}};
  return effect;
}

TEST(PopulationText, SentenceAndTables) {
  const std::string text = PopulationText(Sample());
  for (const char* part : {"w = 0.43 +- 0.061 (4 clusters", "38 % of the mean squared error",
                           "0.116 m half a second after a push that gives 1 m/s with its tail",
                           "person A", "condition p", "r0", "1.35", "-0.12"}) {
    EXPECT_TRUE(Contains(text, part)) << part << "\n" << text;
  }
  // By person, condition and effect.
  EXPECT_LT(text.rfind("r0"), text.rfind("r1"));
  EXPECT_LT(text.rfind("r1"), text.rfind("r2"));
  const TextTable groups = EffectGroupsTable(Sample());
  ASSERT_EQ(groups.rows().size(), 5u);  // header, two people, two conditions
  EXPECT_EQ(groups.rows()[1][2], "0.05");
}

TEST(PopulationText, PeopleWhoTouchHaveNoEffects) {
  RecordingEffect effect = Sample();
  effect.recordings.clear();
  EXPECT_TRUE(Contains(PopulationText(effect), "No recording effect"));
}

}  // namespace
}  // namespace pushid
