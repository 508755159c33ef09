// SVG text: escaped, whole, with round ticks.
#include "ident/figures/svg.h"

#include <gtest/gtest.h>

#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(Svg, TextIsEscaped) {
  EXPECT_EQ(EscapeXml("a<b & \"c\"\n"), "a&lt;b &amp; &quot;c&quot; ");
  SvgPicture svg(100, 50, "<title>");
  svg.Text(1, 2, "x < y", "ink small");
  const std::string text = svg.ToString();
  EXPECT_TRUE(Contains(text, "x &lt; y"));
  EXPECT_TRUE(Contains(text, "<title>&lt;title&gt;</title>"));
  EXPECT_TRUE(Contains(text, "class=\"ink small\""));
  EXPECT_EQ(text.find("<svg "), 0u);
  EXPECT_EQ(text.substr(text.size() - 7), "</svg>\n");
}

TEST(Svg, NegativeNumbersHaveAMinusSign) {
  SvgPicture svg(100, 50, "");
  svg.Text(1, 2, "-0.5 (-1, 2) [-3] X-07 1e-05 2020-01-02 a - b");
  EXPECT_TRUE(
      Contains(svg.ToString(), ">\u22120.5 (\u22121, 2) [\u22123] X-07 1e-05 2020-01-02 a - b<"));
}

TEST(Svg, AnEmptyTextIsNoElement) {
  SvgPicture svg(100, 50, "");
  svg.Text(1, 2, "");
  EXPECT_FALSE(Contains(svg.ToInline(), "<text"));
}

// One element, from point to point in tenths of a pixel; a minus parts numbers by itself.
TEST(Svg, LinesOfOneLookAreOnePath) {
  SvgPicture svg(100, 50, "");
  svg.Lines({{52, 10.04, 52, 14}, {0, 0, -0.5, 20.25}}, "axis");
  svg.Lines({}, "grid");
  const std::string text = svg.ToInline();
  EXPECT_TRUE(Contains(text, "<path class=\"axis\" d=\"M52 10l0 4M0 0l-.5 20.3\"/>"));
  EXPECT_FALSE(Contains(text, "grid"));
}

TEST(Svg, NumbersAreShort) {
  EXPECT_EQ(SvgNumber(3.0), "3");
  EXPECT_EQ(SvgNumber(-0.001), "0");
  EXPECT_EQ(SvgNumber(1.0 / 3.0), "0.33");
  EXPECT_EQ(SvgNumber(120.5), "120.5");
  EXPECT_EQ(SvgNumber(100.0), "100");
}

TEST(Svg, TicksAreRoundAndInside) {
  EXPECT_EQ(SvgScale(0, 3, 0, 1).Ticks(3), std::vector<double>({0, 1, 2, 3}));
  EXPECT_EQ(SvgScale(-600, 600, 1, 0).Ticks(3), std::vector<double>({-500, 0, 500}));
  EXPECT_EQ(SvgScale(-49, 49, 1, 0).Ticks(4), std::vector<double>({-40, -20, 0, 20, 40}));
  EXPECT_EQ(SvgScale(0, 0, 0, 1).Ticks(2).size(), 3u);  // an empty range is drawn as 0 .. 1
  EXPECT_NEAR(SvgScale(0, 10, 100, 0)(2.5), 75.0, 1e-12);
}

TEST(Svg, ColoursRunFromDarkToBright) {
  EXPECT_EQ(ColourOf(-1), "#440154");
  EXPECT_EQ(ColourOf(1), "#fde725");
  EXPECT_EQ(ColourOf(0.2), "#414487");
  EXPECT_EQ(SignedColourOf(-2), "#7f3b08");  // brown
  EXPECT_EQ(SignedColourOf(0), "#f4f4f4");
  EXPECT_EQ(SignedColourOf(1), "#053061");  // blue
}

}  // namespace
}  // namespace pushid
