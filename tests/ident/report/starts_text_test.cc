// What a report says of several starts.
#include <gtest/gtest.h>

#include "ident/fit/fit.h"
#include "ident/report/report_text.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(AcrossStarts, OneStartSaysNothing) {
  EXPECT_EQ(AcrossStartsText(Fit(MakePendulums(TinyStudy()), DefaultFit(TinyStudy()))), "");
}

TEST(AcrossStarts, CountsTheGoodOnesAndTheirSpread) {
  FitOptions options = DefaultFit(TinyStudy());
  options.num_starts = 3;
  FitResult result = Fit(MakePendulums(TinyStudy()), options);
  ASSERT_EQ(result.starts.size(), 3u);
  EXPECT_TRUE(Contains(AcrossStartsText(result), "3 of 3 starts"));
  // Push one of them away: a start that ended elsewhere is not part of the spread.
  const int other = result.best_start == 0 ? 1 : 0;
  result.starts[other].cost = 2.0 * result.cost;
  result.starts[other].to.shared[0] = 1e6;
  const std::string text = AcrossStartsText(result);
  EXPECT_TRUE(Contains(text, "2 of 3 starts"));
  EXPECT_FALSE(Contains(text, "1e+06")) << text;
  EXPECT_TRUE(Contains(ReportText({result, {}, {}, {}, {}}), text));
}

}  // namespace
}  // namespace pushid
