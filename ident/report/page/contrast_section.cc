// ident: the difference between two values of a label, with a forest around zero.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/report/contrast_text.h"
#include "ident/report/page/sections.h"

namespace pushid {
namespace {

constexpr double kContrastWidth = 900, kContrastRow = 40, kContrastTop = 40, kContrastLeft = 150,
                 kContrastRight = 700;
constexpr char kUntoldLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
constexpr char kToldLook[] = "fill:none;stroke-width:3;stroke:#d55e00";
constexpr double kContrastLevel = 0.05;

// Every row has its own scale, with zero in the middle: units differ, their signs do not.
std::string ContrastForest(const Contrast& contrast) {
  const double height =
      kContrastTop + 10 + kContrastRow * static_cast<double>(contrast.rows.size());
  SvgPicture svg(kContrastWidth, height,
                 "differences: " + contrast.second + " less " + contrast.first);
  DrawLegend({{"95 %", kUntoldLook}, {"differs after Holm's correction", kToldLook}}, kContrastLeft,
             16, &svg);
  const double middle = 0.5 * (kContrastLeft + kContrastRight);
  svg.Line(middle, kContrastTop - 12, middle, height - 10, "axis");
  double y = kContrastTop + 0.4 * kContrastRow;
  for (const ContrastRow& row : contrast.rows) {
    double reach = std::abs(row.difference);
    for (double end : {row.lower95, row.upper95}) {
      if (std::isfinite(end)) reach = std::max(reach, std::abs(end));
    }
    reach = reach > 0.0 ? 1.08 * reach : 1.0;
    const SvgScale scale(-reach, reach, kContrastLeft, kContrastRight);
    svg.Text(kContrastLeft - 12, y + 4, row.name, "ink end");
    svg.Line(kContrastLeft, y + 12, kContrastRight, y + 12, "grid");
    for (double tick : scale.Ticks(6)) {
      svg.Line(scale(tick), y + 12, scale(tick), y + 15, "axis");
      svg.Text(scale(tick), y + 24, Rounded(tick, 6), "faint small middle");
    }
    const double from = std::isfinite(row.lower95) ? scale(row.lower95) : kContrastLeft;
    const double to = std::isfinite(row.upper95) ? scale(row.upper95) : kContrastRight;
    svg.Polyline({{from, y}, {to, y}}, row.p_holm < kContrastLevel ? kToldLook : kUntoldLook);
    svg.Circle(scale(row.difference), y, 4.5, "ink",
               row.name + ": " + Rounded(row.difference, 4) + " " + row.unit);
    svg.Text(kContrastRight + 8, y + 4,
             (row.unit == "1" ? "" : row.unit + ", ") + "Holm's p " + Rounded(row.p_holm, 2),
             "faint small");
    y += kContrastRow;
  }
  return svg.ToInline();
}

TextTable ContrastNumbers(const Contrast& contrast) {
  TextTable numbers({"parameter", "unit", "first", "second", "difference", "lower95", "upper95",
                     "effect_sd", "p", "p_holm"});
  for (const ContrastRow& row : contrast.rows) {
    numbers.Add(std::vector<std::string>{
        row.name, row.unit, DoubleText(row.first), DoubleText(row.second),
        DoubleText(row.difference), DoubleText(row.lower95), DoubleText(row.upper95),
        row.effect ? DoubleText(*row.effect) : "", DoubleText(row.p), DoubleText(row.p_holm)});
  }
  return numbers;
}

}  // namespace

ReportSection ContrastSection(const ReportSource& source) {
  ReportSection section;
  if (!source.fit.contrast) return section;
  const Contrast& contrast = *source.fit.contrast;
  section.title = "By " + contrast.label + ": " + contrast.second + " less " + contrast.first;
  section.Say(ContrastText(source.fit));
  section.Show("", ContrastTable(contrast));
  section.figures.push_back({"contrast",
                             "Differences (dots) with their 95 % intervals. Every row has its own "
                             "scale around zero; an open interval extends to the edge.",
                             ContrastForest(contrast), ContrastNumbers(contrast)});
  return section;
}

}  // namespace pushid
