// The glossary of parameters: every row, in words and in Markdown.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "ident/parameters/parameter_table.h"
#include "models/parameters.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(ParameterGlossary, HasARowForEveryParameter) {
  const std::string text = ParameterGlossary();
  EXPECT_EQ(
      text.find("| name | symbol | unit | without preset | bounds | meaning | when to free it |\n"
                "|---|---|---|--:|---|---|---|\n| mu | mu | N s/m | 100 | -2000 to 2000 | drag of "
                "the stepping feet (not floor friction) | always: with Kp_x and Kp_y held it is "
                "the whole drag of the stepping feet |\n"),
      0u);
  std::istringstream lines(text);
  std::string line;
  for (int i = -2; std::getline(lines, line); ++i) {
    ASSERT_LT(i, kFirstOwnParameter);
    if (i >= 0) {
      EXPECT_EQ(line.find("| " + std::string(kParameterNames[i]) + " | "), 0u) << line;
    }
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + kFirstOwnParameter);
}

}  // namespace
}  // namespace pushid
