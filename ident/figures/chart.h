// ident: charts as data: panels with axes, lines, bands, bars and coloured cells, drawn into SVG
// pictures of any width. Pages, files for papers and Python draw the same data.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/figures/svg.h"

namespace pushid {

using ChartPoints = std::vector<std::pair<double, double>>;

// Looks of lines and areas that stay distinct on light and dark paper, for the colour-blind and in
// grey. Looks that many panels use are classes of SvgStyle.
inline constexpr char kMeasuredLook[] = "ink";
inline constexpr char kPredictedLook[] = "predicted";
inline constexpr char kWideBandLook[] = "band wide";
inline constexpr char kNarrowBandLook[] = "band narrow";
inline constexpr char kLiftedLook[] = "lifted";  // a foot off the ground
inline constexpr char kDotLook[] = "stroke:none;fill:#3b82f6";
inline constexpr char kLimitLook[] = "fill:none;stroke-dasharray:5 4;stroke:#d55e00";
inline constexpr char kMarkLook[] = "fill:none;stroke-width:1.2;stroke:#d55e00";

// Wanted width of a panel: three fit side by side on a page, one on a telephone and in a journal's
// column; of small panels four, one and two.
inline constexpr double kPanelWidth = 332, kPanelHeight = 190;
inline constexpr double kSmallWidth = 250, kSmallHeight = 160;

struct ChartLine {
  ChartPoints points;
  std::string look;
  bool dots = false;
};

struct ChartBand {
  ChartPoints lower, upper;
  std::string look;
};

// A strip under the plot with bars along x over the times of a state.
struct ChartLane {
  std::string name;
  std::vector<std::pair<double, double>> bars;
  std::string look;
};

// Along x, in a row of y_categories.
struct ChartBar {
  double row = 0.0, from = 0.0, to = 0.0;
  std::string look;
};

struct Chart {
  std::string title = {}, x_label = {};
  std::string y_label = {};  // at the right end of the title's line
  std::vector<ChartBand> bands = {};
  std::vector<ChartLine> lines = {};
  std::vector<ChartLane> lanes = {};
  std::vector<ChartBar> bars = {};
  std::vector<double> levels = {};               // dashed, across
  std::vector<double> marks = {};                // upright
  std::optional<double> x_from = {}, x_to = {};  // instead of the data's own range
  std::optional<double> y_from = {}, y_to = {};
  bool logarithmic_x = false;  // x and y are given as log10
  bool logarithmic_y = false;
  bool bare_y = false;  // no numbers upwards: the rows are few and named
  // Names at y = 0, 1, ... downwards; right of them.
  std::vector<std::string> y_categories = {}, y_notes = {};
  // A table of signed numbers as colours, blue below zero and orange above; full_cell: the value of
  // the strongest one.
  std::vector<std::string> x_categories = {};
  std::vector<std::vector<double>> cells = {};  // [row][column]; NaN: "-"
  double full_cell = 1.0;
  // Wanted height; rows of categories have their own.
  double width = kPanelWidth, height = kPanelHeight;
  double row = 16, bar = 0.72;  // height of a row, and the share of it that a bar fills

  void Shrink() { width = kSmallWidth, height = kSmallHeight; }
};

// A look and its meaning.
struct LegendEntry {
  std::string name, look;
};

// Charts that belong together, with one legend.
struct Figure {
  std::vector<LegendEntry> legend;
  std::vector<Chart> panels;
  std::string heading = {};  // above everything; may be empty
};

// Draws a panel as a picture of its own, as wide as wanted.
SvgPicture DrawPanel(const Chart& chart);
// Draws all panels in one picture, as many side by side as fit.
SvgPicture DrawFigure(const Figure& figure, double width, const std::string& title);

double LegendWidth(const std::vector<LegendEntry>& entries);
void DrawLegend(const std::vector<LegendEntry>& entries, double x, double y, SvgPicture* svg);

}  // namespace pushid
