// The training curve: stages apart, the best point marked.
#include <gtest/gtest.h>

#include "ident/training/training_run.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(CurveSvgTest, StagesHavePanelsAndTheBestPointIsNamed) {
  std::vector<TrainingPoint> curve;
  for (int i = 1; i <= 6; ++i) {
    curve.push_back({i, 1.0 / i, i == 5 ? 0.02 : 0.1, i <= 3 ? "first" : "second"});
  }
  const std::string svg = TrainingCurveSvg(curve, "a & b");
  EXPECT_TRUE(Contains(svg, ">first<"));
  EXPECT_TRUE(Contains(svg, ">second<"));
  EXPECT_TRUE(Contains(svg, "best 0.02 at 5"));
  EXPECT_TRUE(Contains(svg, "a &amp; b"));
  size_t lines = 0;
  for (size_t at = 0; (at = svg.find("<path", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 4u);
}

}  // namespace
}  // namespace pushid
