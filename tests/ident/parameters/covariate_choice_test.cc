// The words of --covariate.
#include <gtest/gtest.h>

#include "ident/parameters/parameter_table.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(ParseCovariates, ParametersAndTheirKeys) {
  const auto read = ParseCovariates("Kp_theta ~ age + height; Kd_theta~age ;");
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  ASSERT_EQ(read.value().size(), 2u);
  EXPECT_EQ(read.value()[0].parameter, "Kp_theta");
  EXPECT_EQ(read.value()[0].keys, (std::vector<std::string>{"age", "height"}));
  EXPECT_EQ(read.value()[1].parameter, "Kd_theta");
  EXPECT_EQ(read.value()[1].keys, (std::vector<std::string>{"age"}));
  EXPECT_TRUE(ParseCovariates("").value().empty());
}

TEST(ParseCovariates, NamesWhatIsMisspelt) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"Kp_theta", "'Kp_theta' is not PARAMETER ~ KEY"},
      {"Kp_theta ~", "is not PARAMETER"},
      {"~ age", "is not PARAMETER"},
      {"Kp_theta ~ age +", "is not PARAMETER"},
      {"Kp_theta ~ age + + height", "is not PARAMETER"},
      {"Kp_theta ~ age ~ height", "is not PARAMETER"},
      {"mu ~ age; mu ~ age", "names age of mu twice"},
  };
  for (const auto& [text, message] : bad) {
    EXPECT_TRUE(Contains(ProblemOf(ParseCovariates(text)), message));
  }
}

}  // namespace
}  // namespace pushid
