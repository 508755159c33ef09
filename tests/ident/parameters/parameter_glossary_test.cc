// The glossary of parameters: every row, in words and in Markdown.
#include <gtest/gtest.h>

#include <algorithm>

#include "ident/parameters/parameter_table.h"
#include "models/parameters.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(ParameterGlossary, HasARowForEveryParameter) {
  const TextTable table = ParameterGlossary();
  const auto& rows = table.rows();
  ASSERT_EQ(rows.size(), 1u + kFirstOwnParameter);
  EXPECT_EQ(rows[1], (std::vector<std::string>{
                         "mu", "mu", "N s/m", "100", "-2000 to 2000",
                         "drag of the stepping feet (not floor friction)",
                         "always: with Kp_x and Kp_y held it is the whole drag of the stepping "
                         "feet"}));
  for (int i = 0; i < kFirstOwnParameter; ++i) EXPECT_EQ(rows[1 + i][0], kParameterNames[i]);
}

TEST(ParameterGlossary, IsATableInMarkdown) {
  const std::string text = ParameterGlossaryMarkdown();
  EXPECT_EQ(
      text.find("| name | symbol | unit | without preset | bounds | meaning | when to free it |\n"
                "|---|---|---|--:|---|---|---|\n| mu | mu | N s/m | 100 |"),
      0u);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + kFirstOwnParameter);
}

}  // namespace
}  // namespace pushid
