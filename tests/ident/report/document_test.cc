// Reports as page, text and numbers: escaped, whole, nothing shown that is not there.
#include "ident/report/document.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ident/figures/chart.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Report SampleReport() {
  TextTable table({"name", ">value"});
  table.Add({"a<b", "1"});
  TextTable numbers({"time_s", "what"});
  numbers.Add({"0.5", "say \"x\", y"});
  ReportSection full{"full",
                     "Full & <whole>",
                     {"one\ntwo"},
                     {{"try", "pushid-fit --x='1<2'"}},
                     {{"caption", table}},
                     {{"a/../b", "see", {{}, {Chart()}}, numbers}},
                     {{"fold <1>", {}}},
                     ""};
  ReportSection empty;
  empty.id = "empty";
  empty.title = "Nothing";
  return {"Title <&>", "sub", {full, empty}};
}

TEST(ReportDocument, PageEscapesAndLeavesOutEmptySections) {
  const std::string page = ToPage(SampleReport());
  for (const char* part :
       {"<h1>Title &lt;&amp;&gt;</h1>", "<h2>Full &amp; &lt;whole&gt;</h2>", "<p>one<br>two</p>",
        "<pre>pushid-fit --x=&#39;1&lt;2&#39;</pre>", "<td>a&lt;b</td><td class=\"number\">1</td>",
        "<summary>fold &lt;1&gt;</summary>", "<a href=\"#full\">"}) {
    EXPECT_TRUE(Contains(page, part));
  }
  EXPECT_FALSE(Contains(page, "empty"));
  EXPECT_FALSE(Contains(page, "<script"));
}

TEST(ReportDocument, TextHasTheSameContent) {
  const std::string text = ToText(SampleReport());
  for (const char* part : {"Full & <whole>\n==============\none\ntwo\n", "advice: try\n",
                           "a<b       1\n", "fold <1>\n"}) {
    EXPECT_TRUE(Contains(text, part));
  }
  EXPECT_FALSE(Contains(text, "Nothing"));
}

TEST(ReportDocument, APageIsNoPdf) {
  for (const char* page : {"a.html", "A.B/report.htm", "-", "report", ""}) {
    EXPECT_FALSE(CheckPageName("--html_out", page)) << page;
  }
  EXPECT_TRUE(Contains(ProblemOf(CheckPageName("--html_out", "out/report.pdf")),
                       "--html_out is 'out/report.pdf'"));
}

TEST(ReportDocument, FilesStayInTheirFolderAndQuote) {
  std::map<std::string, std::string> files;
  for (const auto& [name, text] : FigureFiles(SampleReport())) files[name] = text;
  EXPECT_EQ(files["a____b.csv"], "time_s,what\n0.5,\"say \"\"x\"\", y\"\n");
  EXPECT_TRUE(Contains(files["a____b.svg"], "<title>a____b</title>"));
  EXPECT_EQ(files["table_full_1.csv"], "name,value\na<b,1\n");
  EXPECT_EQ(files["captions.md"],
            "# Title <&>\n\n**a____b** see\n\n**table_full_1** Full & <whole>: caption.\n");
}

TEST(ReportDocument, TablesWithACaptionFold) {
  const std::string page = ToPage(SampleReport());
  EXPECT_LT(page.find("<summary>caption</summary>"), page.find("<table>"));
  EXPECT_LT(page.find("<figure>"), page.find("<p>one"));
}

TEST(ReportDocument, AWidgetIsOnThePageAlone) {
  Report report;
  report.sections = {{"motion", "Motion"}};
  report.sections[0].widget = "<b>moving</b>";
  EXPECT_TRUE(Contains(ToPage(report), "<b>moving</b>"));
  EXPECT_FALSE(Contains(ToText(report), "moving"));
}

// A lane takes its height from the plot: the axis stays, the line moves up.
TEST(Chart, LanesLieBetweenPlotAndAxis) {
  Chart chart;
  chart.lines = {{{{0, 0}, {4, 1}}, "ink", false}};
  chart.width = 200;
  chart.height = 100;
  const std::string plain = DrawPanel(chart).ToInline();
  chart.lanes = {{"left", {{1, 2}, {3, 4}}, "fill:#123456"}, {"right", {}, "fill:#123456"}};
  const std::string lanes = DrawPanel(chart).ToInline();
  size_t bars = 0;
  for (size_t at = lanes.find("#123456"); at != std::string::npos;
       at = lanes.find("#123456", at + 1)) {
    ++bars;
  }
  EXPECT_EQ(bars, 2u);
  // x runs over 144 pixels from 44 on; the bars over a quarter of them each.
  EXPECT_TRUE(Contains(lanes, "<rect x=\"80\""));
  EXPECT_TRUE(Contains(lanes, "<rect x=\"152\""));
  EXPECT_TRUE(Contains(lanes, "width=\"36\""));
  for (const char* part : {">left<", ">right<"}) {
    EXPECT_TRUE(Contains(lanes, part));
    EXPECT_FALSE(Contains(plain, part));
  }
}

TEST(Chart, DrawsWhatItIsGiven) {
  Chart chart;
  chart.title = "x & y";
  chart.lines = {{{{0, 0}, {1, 2}, {2, NAN}, {3, 1}}, kPredictedLook, false},
                 {{{0, 1}, {1, 1}}, "fill:#000", true}};
  chart.bands = {{{{0, -1}, {3, -1}}, {{0, 1}, {3, 1}}, kWideBandLook}};
  chart.levels = {1.5};
  const std::string svg = DrawFigure({{}, {chart, Chart()}}, 400, "two").ToInline();
  EXPECT_FALSE(Contains(svg, "nan"));
  EXPECT_FALSE(Contains(svg, "inf"));
  EXPECT_TRUE(Contains(svg, "x &amp; y"));
  EXPECT_TRUE(Contains(svg, "stroke-dasharray"));
  size_t circles = 0;
  for (size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    ++circles;
  }
  EXPECT_EQ(circles, 2u);
}

TEST(Chart, ThinLinesKeepTheirShape) {
  SvgPicture svg(100, 100, "");
  ChartPoints points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(i, i <= 50 ? i : 100 - i);
  svg.Polyline(points, "ink");
  EXPECT_TRUE(Contains(svg.ToInline(), "d=\"M0 0l50 50 50-50\""));
}

}  // namespace
}  // namespace pushid
