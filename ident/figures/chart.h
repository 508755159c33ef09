// ident: panels with axes, lines and bands, drawn into an SVG picture.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/figures/svg.h"

namespace pushid {

using ChartPoints = std::vector<std::pair<double, double>>;

// Told apart on light and on dark paper, by the colour-blind and in grey. Those of many panels are
// classes of SvgStyle.
inline constexpr char kMeasuredLook[] = "ink";
inline constexpr char kPredictedLook[] = "predicted";
inline constexpr char kWideBandLook[] = "band wide";
inline constexpr char kNarrowBandLook[] = "band narrow";
inline constexpr char kLiftedLook[] = "lifted";  // a foot off the ground
inline constexpr char kLimitLook[] = "fill:none;stroke-dasharray:5 4;stroke:#d55e00";
inline constexpr char kMarkLook[] = "fill:none;stroke-width:1.2;stroke:#d55e00";

struct ChartLine {
  ChartPoints points;
  std::string look;
  bool dots = false;
};

struct ChartBand {
  ChartPoints lower, upper;
  std::string look;
};

// A strip under the plot with bars along x: when something is so.
struct ChartLane {
  std::string name;
  std::vector<std::pair<double, double>> bars;
  std::string look;
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartBand> bands;
  std::vector<ChartLine> lines;
  std::vector<ChartLane> lanes;
  std::vector<double> levels;             // dashed, across
  std::vector<double> marks;              // upright
  std::optional<double> y_from, y_to;     // instead of the data's own range
  bool logarithmic = false;               // powers of ten upwards; y given as log10
  std::vector<std::string> y_categories;  // names at y = 0, 1, ... instead of numbers
  bool bare_x = false;                    // the panel below has the same x axis, with its numbers
};

// Axes and labels lie within the box.
void DrawChart(const Chart& chart, const SvgBox& box, SvgPicture* svg);

// Small panels side by side, `columns` in a row.
std::string DrawCharts(const std::vector<Chart>& charts, const std::string& title, int columns,
                       double width, double height);

// What the lines of a picture mean, from x on.
struct LegendEntry {
  std::string name, look;
};
double LegendWidth(const std::vector<LegendEntry>& entries);
void DrawLegend(const std::vector<LegendEntry>& entries, double x, double y, SvgPicture* svg);

// A table of signed numbers as colours.

struct HeatMap {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> values;  // [row][column]; 0 is paper
  double full = 1.0;                        // the value of the strongest colour
};

// Blue below zero, orange above.
std::string DrawHeatMap(const HeatMap& map);

}  // namespace pushid
