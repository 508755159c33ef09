#include "ident/figures/chart.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kLane = 12;     // height, as that of its name
constexpr double kLetter = 7.1;  // width of a small one, about
constexpr double kLine = 14;     // height of a small one with its space
constexpr double kBoldLetter = 7.2;
constexpr double kValueWidth = 36;    // a cell that is wider shows its number
constexpr double kLeastShare = 0.01;  // of the strongest colour, that is drawn

struct Range {
  double from = INFINITY, to = -INFINITY;

  void Add(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  void Add(const ChartPoints& points, double std::pair<double, double>::*axis) {
    for (const auto& point : points) Add(point.*axis);
  }
  Range Widened(double share) const {
    if (!(from <= to)) return {0.0, 1.0};
    const double air = from < to ? share * (to - from) : std::max(1e-9, 0.05 * std::abs(from));
    return {from - air, to + air};
  }
};

Range RangeOf(const Chart& chart, double std::pair<double, double>::*axis) {
  Range range;
  for (const ChartLine& line : chart.lines) range.Add(line.points, axis);
  for (const ChartBand& band : chart.bands) {
    for (const ChartPoints* edge : {&band.lower, &band.upper}) range.Add(*edge, axis);
  }
  return range;
}

double Longest(const std::vector<std::string>& names) {
  size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  return kLetter * static_cast<double>(longest);
}

std::string Cut(const std::string& name, double width, double letter = kLetter) {
  const size_t most = static_cast<size_t>(std::max(2.0, width / letter));
  return name.size() <= most ? name : name.substr(0, most - 1) + "~";
}

// The room around the plot.
struct Margins {
  double left = 44, right = 12, top = 22, bottom = 36;
  bool upright = false;  // heads of columns

  Margins(const Chart& chart, double width) {
    if (chart.bare_y) left = 10;
    if (!chart.y_categories.empty())
      left = 10 + std::min(0.42 * width, Longest(chart.y_categories));
    if (!chart.y_notes.empty()) right = 14 + std::min(0.3 * width, Longest(chart.y_notes));
    if (chart.title.empty() && chart.y_label.empty()) top = 8;
    if (chart.x_label.empty()) bottom = 22;
    if (chart.cells.empty()) return;
    const double columns = std::max<double>(1.0, static_cast<double>(chart.x_categories.size()));
    upright = Longest(chart.x_categories) + 4 > (width - left - right) / columns;
    top += upright ? 4 + std::min(120.0, Longest(chart.x_categories)) : 16;
    bottom = chart.x_label.empty() ? 8 : 22;
  }
};

class Panel {
 public:
  Panel(const Chart& chart, const SvgBox& box, SvgPicture* svg)
      : chart_(chart),
        box_(box),
        margins_(chart, box.width),
        left_(box.x + margins_.left),
        right_(box.x + box.width - margins_.right),
        top_(box.y + margins_.top),
        floor_(box.y + box.height - margins_.bottom),
        bottom_(floor_ - kLane * static_cast<double>(chart.lanes.size())),
        x_(XScale()),
        y_(YScale()),
        svg_(*svg) {}

  void Draw() {
    Heads();
    if (chart_.cells.empty()) {
      XAxis();
    } else {
      Cells();
    }
    YAxis();
    for (const ChartBand& band : chart_.bands) {
      ChartPoints outline = Placed(band.lower);
      const ChartPoints back = Placed(band.upper);
      outline.insert(outline.end(), back.rbegin(), back.rend());
      svg_.Polyline(outline, band.look);
    }
    for (const ChartBar& bar : chart_.bars) {
      const double from = Inside(bar.from), to = Inside(bar.to), y = y_(bar.row);
      const double height = chart_.bar * chart_.row;
      svg_.Rect({std::min(from, to), y - 0.5 * height, std::abs(to - from), height}, bar.look);
    }
    for (double level : chart_.levels) svg_.Line(left_, y_(level), right_, y_(level), kLimitLook);
    for (double mark : chart_.marks) svg_.Line(x_(mark), top_, x_(mark), bottom_, kMarkLook);
    for (const ChartLine& line : chart_.lines) {
      const ChartPoints placed = Placed(line.points);
      for (const auto& [x, y] : placed) {
        if (line.dots) svg_.Circle(x, y, 3.0, line.look);
      }
      if (!line.dots) svg_.Polyline(placed, line.look);
    }
    Lanes();
  }

 private:
  SvgScale XScale() const {
    if (!chart_.cells.empty())
      return {0.0, static_cast<double>(chart_.x_categories.size()), left_, right_};
    Range range = RangeOf(chart_, &std::pair<double, double>::first);
    for (double mark : chart_.marks) range.Add(mark);
    for (const ChartBar& bar : chart_.bars) range.Add(bar.from), range.Add(bar.to);
    range = range.Widened(chart_.bare_y || !chart_.y_categories.empty() ? 0.05 : 0.0);
    return {chart_.x_from.value_or(range.from), chart_.x_to.value_or(range.to), left_, right_};
  }
  SvgScale YScale() const {
    // Names run downwards.
    if (!chart_.y_categories.empty()) {
      return {-0.5, static_cast<double>(chart_.y_categories.size()) - 0.5, top_, bottom_};
    }
    Range range = RangeOf(chart_, &std::pair<double, double>::second);
    for (double level : chart_.levels) range.Add(level);
    range = range.Widened(0.06);
    return {chart_.y_from.value_or(range.from), chart_.y_to.value_or(range.to), bottom_, top_};
  }

  double Inside(double x) const { return std::clamp(x_(x), left_, right_); }

  // Infinite ends of intervals go to the edge.
  ChartPoints Placed(const ChartPoints& points) const {
    ChartPoints placed;
    for (const auto& [x, y] : points) {
      if (std::isnan(x) || !std::isfinite(y)) continue;
      placed.emplace_back(std::isinf(x) ? (x < 0.0 ? left_ : right_) : Inside(x),
                          std::clamp(y_(y), top_ - 2.0, bottom_ + 2.0));
    }
    return placed;
  }

  // A title that is too long for its place above the plot begins at the panel's edge.
  void Heads() {
    const double y = box_.y + 14, edge = box_.x + 10;
    const double end = chart_.y_label.empty()
                           ? box_.x + box_.width - 4
                           : right_ - kLetter * static_cast<double>(chart_.y_label.size());
    const double wide = kBoldLetter * static_cast<double>(chart_.title.size());
    const double from = chart_.y_categories.empty() && left_ + wide < end ? left_ : edge;
    svg_.Text(right_, y, chart_.y_label, "faint small end");
    svg_.Text(from, y, Cut(chart_.title, end - from, kBoldLetter), "ink bold");
  }

  // The lanes stand between the plot and its axis.
  void Lanes() {
    double y = bottom_ + 2;
    for (const ChartLane& lane : chart_.lanes) {
      svg_.Line(left_, y + kLane - 3, right_, y + kLane - 3, "grid");
      for (const auto& [from, to] : lane.bars) {
        svg_.Rect({x_(from), y + 2, x_(to) - x_(from), kLane - 5}, lane.look);
      }
      svg_.Text(left_ - 5, y + kLane - 1.5, lane.name, "faint small end");
      y += kLane;
    }
  }

  void XAxis() {
    std::vector<SvgLine> axis = {{left_, floor_, right_, floor_}}, grid;
    double free_from = box_.x;
    for (double tick : chart_.logarithmic_x ? Powers(x_) : x_.Ticks(5)) {
      axis.push_back({x_(tick), floor_, x_(tick), floor_ + 4});
      if (chart_.logarithmic_x || !chart_.y_categories.empty())
        grid.push_back({x_(tick), top_, x_(tick), bottom_});
      const std::string text = TickText(chart_.logarithmic_x ? std::pow(10.0, tick) : tick);
      const double half = 3.4 * static_cast<double>(text.size());
      // A number that would touch the one before, or the edge, is left out.
      if (x_(tick) - half < free_from || x_(tick) + half > box_.x + box_.width) continue;
      free_from = x_(tick) + half + 4;
      svg_.Text(x_(tick), floor_ + 15, text, "ink small middle");
    }
    svg_.Lines(grid, "grid");
    svg_.Lines(axis, "axis");
    svg_.Text(0.5 * (left_ + right_), floor_ + 29, chart_.x_label, "faint small middle");
  }

  void YAxis() {
    std::vector<SvgLine> grid;
    for (size_t i = 0; i < chart_.y_categories.size(); ++i) {
      const double y = y_(static_cast<double>(i));
      if (chart_.cells.empty()) grid.push_back({left_, y, right_, y});
      svg_.Text(left_ - 6, y + 4, Cut(chart_.y_categories[i], margins_.left - 6), "ink small end");
      if (i < chart_.y_notes.size())
        svg_.Text(right_ + 6, y + 4, Cut(chart_.y_notes[i], margins_.right - 4), "faint small");
    }
    const bool numbers = chart_.y_categories.empty() && !chart_.bare_y;
    double below = bottom_ + kLine;  // the number under the next one
    for (double tick : numbers ? y_.Ticks(3) : std::vector<double>()) {
      if (chart_.logarithmic_y && tick != std::floor(tick)) continue;
      grid.push_back({left_, y_(tick), right_, y_(tick)});
      // Names of lanes stand below the plot.
      if ((!chart_.lanes.empty() && y_(tick) > bottom_ - 6) || below - y_(tick) < kLine) continue;
      below = y_(tick);
      svg_.Text(left_ - 5, y_(tick) + 3.5,
                TickText(chart_.logarithmic_y ? std::pow(10.0, tick) : tick), "faint small end");
    }
    svg_.Lines(grid, "grid");
  }

  // Ticks at 1, 2 and 5 times powers of ten, as logarithms; over many powers at these alone.
  static std::vector<double> Powers(const SvgScale& scale) {
    std::vector<double> ticks;
    for (double power = std::floor(scale.from()); power <= scale.to(); ++power) {
      for (double first : {1.0, 2.0, 5.0}) {
        const double tick = power + std::log10(first);
        if (first != 1.0 && scale.to() - scale.from() >= 4.0) continue;
        if (tick >= scale.from() && tick <= scale.to()) ticks.push_back(tick);
      }
    }
    return ticks;
  }

  void Cells() {
    for (size_t j = 0; j < chart_.x_categories.size(); ++j) {
      const double x = x_(static_cast<double>(j) + 0.5);
      if (margins_.upright) {
        svg_.TextUp(x + 4, top_ - 4, Cut(chart_.x_categories[j], 120), "ink small");
      } else {
        svg_.Text(x, top_ - 5, chart_.x_categories[j], "ink small middle");
      }
    }
    const double wide = x_(1.0) - x_(0.0), high = y_(1.0) - y_(0.0);
    for (size_t i = 0; i < chart_.cells.size(); ++i) {
      for (size_t j = 0; j < chart_.cells[i].size(); ++j) {
        const double value = chart_.cells[i][j];
        const double x = x_(static_cast<double>(j)), y = y_(static_cast<double>(i) - 0.5);
        const double share = std::clamp(std::abs(value) / chart_.full_cell, 0.0, 1.0);
        if (share >= kLeastShare) {  // most cells of a large map are paper; NaN never is
          const std::string look = std::string("fill:") + (value < 0.0 ? "#3b82f6" : "#e69f00") +
                                   ";fill-opacity:" + SvgNumber(0.85 * share);
          svg_.Rect(
              {x + 0.5, y + 0.5, wide - 1, high - 1}, look,
              chart_.y_categories[i] + ", " + chart_.x_categories[j] + ": " + Rounded(value, 3));
        }
        const std::string number = std::isnan(value) ? "-" : SvgNumber(value);
        if (wide > kValueWidth) svg_.Text(x + 0.5 * wide, y + 12, number, "ink small middle");
      }
    }
  }

  static std::string TickText(double tick) { return Rounded(std::abs(tick) < 1e-12 ? 0.0 : tick); }

  const Chart& chart_;
  const SvgBox box_;
  const Margins margins_;
  double left_, right_, top_, floor_, bottom_;  // lanes lie between bottom_ and floor_
  SvgScale x_, y_;
  SvgPicture& svg_;
};

// Least share of its wanted width to which a panel shrinks before fewer stand side by side.
constexpr double kNarrowest = 0.65;
constexpr double kLegendRow = 18, kHeading = 22;

// Width of an entry's line, its name and the room after it.
double EntryWidth(const LegendEntry& entry) {
  return 44 + 6.6 * static_cast<double>(entry.name.size());
}

// Height of a panel that is drawn so wide.
double HeightOf(const Chart& chart, double width) {
  // Panels are lower where they are narrower; strips of a row or two keep their height.
  if (chart.y_categories.empty())
    return chart.bare_y ? chart.height : chart.height * std::clamp(width / chart.width, 0.8, 1.0);
  const Margins margins(chart, width);
  return margins.top + margins.bottom + chart.row * static_cast<double>(chart.y_categories.size());
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
  Panel(chart, {0, 0, chart.width, height}, &svg).Draw();
  return svg;
}

SvgPicture DrawFigure(const Figure& figure, double width, const std::string& title) {
  const std::vector<Chart>& panels = figure.panels;
  double widest = 1.0;
  for (const Chart& panel : panels) widest = std::max(widest, panel.width);
  const size_t columns = std::clamp<size_t>(static_cast<size_t>(width / (kNarrowest * widest)), 1,
                                            std::max<size_t>(1, panels.size()));
  const double wide = width / static_cast<double>(columns);
  std::vector<std::vector<LegendEntry>> legend;  // lines, none wider than the picture
  for (const LegendEntry& entry : figure.legend) {
    const bool full = legend.empty() || LegendWidth(legend.back()) + EntryWidth(entry) > width - 20;
    if (full) legend.emplace_back();
    legend.back().push_back(entry);
  }
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
    Panel(panels[i], {x, tops[i / columns], wide, HeightOf(panels[i], wide)}, &svg).Draw();
  }
  return svg;
}

}  // namespace pushid
