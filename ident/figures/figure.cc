// ident: panels and their legend as pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ident/figures/chart.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

// A panel may get so much narrower than wanted before fewer stand side by side.
constexpr double kNarrowest = 0.65;
constexpr double kLegendRow = 18, kHeading = 22;

// Of its line, its name and the room after it.
double EntryWidth(const LegendEntry& entry) {
  return 44 + 6.6 * static_cast<double>(entry.name.size());
}

// Entries by line, so that none is wider than the picture.
std::vector<std::vector<LegendEntry>> LegendLines(const std::vector<LegendEntry>& entries,
                                                  double width) {
  std::vector<std::vector<LegendEntry>> lines;
  double used = width;
  for (const LegendEntry& entry : entries) {
    if (used + EntryWidth(entry) > width) {
      lines.emplace_back();
      used = 0.0;
    }
    lines.back().push_back(entry);
    used += EntryWidth(entry);
  }
  return lines;
}

}  // namespace

double LegendWidth(const std::vector<LegendEntry>& entries) {
  double width = 0.0;
  for (const LegendEntry& entry : entries) width += EntryWidth(entry);
  return width;
}

void DrawLegend(const std::vector<LegendEntry>& entries, double x, double y, SvgPicture* svg) {
  for (const LegendEntry& entry : entries) {
    const bool filled = entry.look.find("stroke:none") != std::string::npos ||
                        entry.look.rfind("band", 0) == 0 || entry.look == kLiftedLook;
    if (filled) {
      svg->Rect({x, y - 9, 18, 10}, entry.look);
    } else {
      svg->Polyline({{x, y - 4}, {x + 18, y - 4}}, entry.look);
    }
    svg->Text(x + 23, y, entry.name, "ink small");
    x += EntryWidth(entry);
  }
}

SvgPicture DrawPanel(const Chart& chart) {
  const double height = HeightOf(chart, chart.width);
  SvgPicture svg(chart.width, height, chart.title);
  DrawChart(chart, {0, 0, chart.width, height}, &svg);
  return svg;
}

SvgPicture DrawFigure(const Figure& figure, double width, const std::string& title) {
  const std::vector<Chart>& panels = figure.panels;
  double widest = 1.0;
  for (const Chart& panel : panels) widest = std::max(widest, panel.width);
  const size_t columns = std::clamp<size_t>(static_cast<size_t>(width / (kNarrowest * widest)), 1,
                                            std::max<size_t>(1, panels.size()));
  const double wide = width / static_cast<double>(columns);
  const auto legend = LegendLines(figure.legend, width - 20);
  const double top =
      (figure.heading.empty() ? 0 : kHeading) + kLegendRow * static_cast<double>(legend.size());
  std::vector<double> tops = {top};
  for (size_t i = 0; i < panels.size(); ++i) {
    if (i % columns == 0) tops.push_back(tops.back());
    const size_t row = i / columns;
    tops[row + 1] = std::max(tops[row + 1], tops[row] + HeightOf(panels[i], wide));
  }
  SvgPicture svg(width, tops.back(), title);
  svg.Text(10, 15, figure.heading, "ink bold");
  for (size_t k = 0; k < legend.size(); ++k) {
    DrawLegend(legend[k], 10, top - kLegendRow * static_cast<double>(legend.size() - k) + 14, &svg);
  }
  for (size_t i = 0; i < panels.size(); ++i) {
    const double x = wide * static_cast<double>(i % columns);
    DrawChart(panels[i], {x, tops[i / columns], wide, HeightOf(panels[i], wide)}, &svg);
  }
  return svg;
}

namespace {

using Rgb = std::array<double, 3>;

// Between stops of even distance; at in [0, 1], clamped.
template <size_t N>
std::string Blend(const std::array<Rgb, N>& stops, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * (N - 1);
  const size_t low = std::min(static_cast<size_t>(place), N - 2);
  std::array<int, 3> rgb{};
  for (int i = 0; i < 3; ++i) {
    const double from = stops[low][i], to = stops[low + 1][i];
    rgb[i] = static_cast<int>(std::lround(from + (place - low) * (to - from)));
  }
  char text[32];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
  return text;
}

}  // namespace

std::string ColourOf(double fraction) {
  static constexpr std::array<Rgb, 6> kStops = {
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  return Blend(kStops, fraction);
}

std::string SignedColourOf(double fraction) {
  static constexpr std::array<Rgb, 7> kStops = {{{127, 59, 8},
                                                 {217, 120, 20},
                                                 {250, 190, 120},
                                                 {244, 244, 244},
                                                 {146, 197, 222},
                                                 {50, 120, 180},
                                                 {5, 48, 97}}};
  return Blend(kStops, 0.5 + 0.5 * fraction);
}

}  // namespace pushid
