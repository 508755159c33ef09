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

constexpr double kContrastLevel = 0.05;

// Every row has its own scale, with zero in the middle: units differ, their signs do not.
Figure ContrastForest(const Contrast& contrast) {
  Figure figure;
  figure.legend = {{"95 %", kIntervalLook}, {"differs after Holm's correction", kToldLook}};
  for (const ContrastRow& row : contrast.rows) {
    double reach = std::abs(row.difference);
    for (double end : {row.lower95, row.upper95}) {
      if (std::isfinite(end)) reach = std::max(reach, std::abs(end));
    }
    reach = reach > 0.0 ? 1.08 * reach : 1.0;
    Chart strip = IntervalStrip({row.name,
                                 row.unit,
                                 row.difference,
                                 0.0,
                                 {{{0.0, row.lower95, row.upper95},
                                   row.p_holm < kContrastLevel ? kToldLook : kIntervalLook}}});
    strip.y_label = "Holm's p " + Rounded(row.p_holm, 2);
    strip.x_from = -reach;
    strip.x_to = reach;
    figure.panels.push_back(strip);
  }
  return figure;
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
  section.figures.push_back(
      {"contrast",
       "Differences (dots) with their 95 % intervals. Every row has its own "
       "scale around zero (upright line); an open interval extends to the edge.",
       ContrastForest(contrast), ContrastNumbers(contrast)});
  return section;
}

}  // namespace pushid
