// ident: drawing panels.
#include "ident/figures/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kAbove = 22, kBelow = 36, kBefore = 52, kAfter = 12;
constexpr int kYTicks = 3;    // about
constexpr double kLane = 12;  // height, as that of its name

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
    range.Add(band.lower, axis);
    range.Add(band.upper, axis);
  }
  return range;
}

// Of its line, its name and the room after it.
double EntryWidth(const LegendEntry& entry) {
  return 46 + 6.2 * static_cast<double>(entry.name.size());
}

class Panel {
 public:
  Panel(const Chart& chart, const SvgBox& box, SvgPicture* svg)
      : chart_(chart),
        left_(box.x + kBefore),
        right_(box.x + box.width - kAfter),
        top_(box.y + kAbove),
        floor_(box.y + box.height - kBelow),
        bottom_(floor_ - kLane * static_cast<double>(chart.lanes.size())),
        x_(XScale()),
        y_(YScale()),
        svg_(*svg) {}

  void Draw() {
    svg_.Text(left_, top_ - 8, chart_.title, "ink bold");
    Axes();
    for (const ChartBand& band : chart_.bands) {
      ChartPoints outline = Placed(band.lower);
      const ChartPoints back = Placed(band.upper);
      outline.insert(outline.end(), back.rbegin(), back.rend());
      svg_.Polyline(outline, band.look);
    }
    for (double level : chart_.levels) svg_.Line(left_, y_(level), right_, y_(level), kLimitLook);
    for (double mark : chart_.marks) svg_.Line(x_(mark), top_, x_(mark), bottom_, kMarkLook);
    for (const ChartLine& line : chart_.lines) Line(line);
    Lanes();
  }

 private:
  SvgScale XScale() const {
    Range range = RangeOf(chart_, &std::pair<double, double>::first);
    for (double mark : chart_.marks) range.Add(mark);
    range = range.Widened(0.0);
    return {range.from, range.to, left_, right_};
  }
  SvgScale YScale() const {
    Range range = RangeOf(chart_, &std::pair<double, double>::second);
    for (double level : chart_.levels) range.Add(level);
    range = range.Widened(0.06);
    if (!chart_.y_categories.empty()) {
      // Names run downwards.
      return {-0.6, static_cast<double>(chart_.y_categories.size()) - 0.4, top_, bottom_};
    }
    return {chart_.y_from.value_or(range.from), chart_.y_to.value_or(range.to), bottom_, top_};
  }

  ChartPoints Placed(const ChartPoints& points) const {
    ChartPoints placed;
    for (const auto& [x, y] : points) {
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      placed.emplace_back(x_(x), std::clamp(y_(y), top_ - 2.0, bottom_ + 2.0));
    }
    return placed;
  }

  void Line(const ChartLine& line) {
    const ChartPoints placed = Placed(line.points);
    if (line.dots) {
      for (const auto& [x, y] : placed) svg_.Circle(x, y, 3.0, line.look);
    } else {
      svg_.Polyline(placed, line.look);
    }
  }

  // Between the plot and its axis.
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

  void Axes() {
    std::vector<SvgLine> axis = {{left_, floor_, right_, floor_}}, grid;
    double free_from = -INFINITY;
    for (double tick : x_.Ticks(5)) {
      axis.push_back({x_(tick), floor_, x_(tick), floor_ + 4});
      const std::string text = TickText(tick);
      const double half = 3.4 * static_cast<double>(text.size());
      // A number that would touch the one before is left out.
      if (chart_.bare_x || x_(tick) - half < free_from) continue;
      free_from = x_(tick) + half + 4;
      svg_.Text(x_(tick), floor_ + 15, text, "ink small middle");
    }
    svg_.Lines(axis, "axis");
    if (!chart_.bare_x) {
      svg_.Text(0.5 * (left_ + right_), floor_ + 29, chart_.x_label, "faint small middle");
    }
    for (size_t i = 0; i < chart_.y_categories.size(); ++i) {
      const double y = y_(static_cast<double>(i));
      grid.push_back({left_, y, right_, y});
      svg_.Text(left_ - 6, y + 4, chart_.y_categories[i], "ink small end");
    }
    for (double tick : chart_.y_categories.empty() ? y_.Ticks(kYTicks) : std::vector<double>()) {
      if (chart_.logarithmic && tick != std::floor(tick)) continue;
      grid.push_back({left_, y_(tick), right_, y_(tick)});
      // The names of lanes stand below.
      if (!chart_.lanes.empty() && y_(tick) > bottom_ - 6) continue;
      const std::string text = chart_.logarithmic ? "1e" + SvgNumber(tick) : TickText(tick);
      svg_.Text(left_ - 5, y_(tick) + 3.5, text, "faint small end");
    }
    svg_.Lines(grid, "grid");
    svg_.Text(right_, top_ - 8, chart_.y_label, "faint small end");
  }

  // "0.002", "1e-05": enough digits for round numbers.
  static std::string TickText(double tick) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", std::abs(tick) < 1e-12 ? 0.0 : tick);
    return text;
  }

  const Chart& chart_;
  double left_, right_, top_, floor_, bottom_;  // lanes lie between bottom_ and floor_
  SvgScale x_, y_;
  SvgPicture& svg_;
};

}  // namespace

void DrawChart(const Chart& chart, const SvgBox& box, SvgPicture* svg) {
  Panel(chart, box, svg).Draw();
}

std::string DrawCharts(const std::vector<Chart>& charts, const std::string& title, int columns,
                       double width, double height) {
  const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
  SvgPicture svg(width * columns, height * rows, title);
  for (size_t i = 0; i < charts.size(); ++i) {
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    DrawChart(charts[i], {width * column, height * row, width, height}, &svg);
  }
  return svg.ToInline();
}

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

namespace {

constexpr double kHigh = 22, kTop = 84;
constexpr size_t kFewColumns = 12;
constexpr double kLeastShare = 0.01;  // of the strongest colour, that is drawn

// The name turned upwards would need another anchor; long names are cut instead.
std::string Short(const std::string& name, size_t most) {
  return name.size() <= most ? name : name.substr(0, most - 1) + "~";
}

}  // namespace

std::string DrawHeatMap(const HeatMap& map) {
  size_t longest = 4;
  for (const std::string& row : map.rows) longest = std::max(longest, row.size());
  const double left = 24 + 6.4 * static_cast<double>(std::min<size_t>(longest, 28));
  const double columns = static_cast<double>(map.columns.size());
  const bool few = map.columns.size() <= kFewColumns;
  const double wide = few ? 64 : 46;
  const double rows = static_cast<double>(map.rows.size());
  // The last name is wider than its column.
  const double after =
      map.columns.empty() ? 12 : 12 + 3.2 * static_cast<double>(map.columns.back().size());
  SvgPicture svg(left + wide * columns + after, kTop + kHigh * rows + 12, map.title);
  svg.Text(12, 18, map.title, "ink bold");
  for (size_t j = 0; j < map.columns.size(); ++j) {
    // Neighbouring names at two or three heights, so that they do not touch.
    const double y = kTop - 10 - 16.0 * static_cast<double>(j % (few ? 2 : 3));
    svg.Text(left + wide * (static_cast<double>(j) + 0.5), y, Short(map.columns[j], 18),
             "ink small middle");
  }
  for (size_t i = 0; i < map.rows.size(); ++i) {
    const double y = kTop + kHigh * static_cast<double>(i);
    svg.Text(left - 8, y + 15, Short(map.rows[i], 28), "ink small end");
    for (size_t j = 0; j < map.columns.size(); ++j) {
      const double value = map.values[i][j];
      const double x = left + wide * static_cast<double>(j);
      const double share = std::clamp(std::abs(value) / map.full, 0.0, 1.0);
      const bool seen = share >= kLeastShare;  // most cells of a large map are paper
      if (seen)
        svg.Rect({x + 1, y + 1, wide - 2, kHigh - 2},
                 std::string("fill:") + (value < 0.0 ? "#3b82f6" : "#e69f00") +
                     ";fill-opacity:" + SvgNumber(0.85 * share),
                 map.rows[i] + ", " + map.columns[j] + ": " + Rounded(value, 3));
      svg.Text(x + 0.5 * wide, y + 15, SvgNumber(value), "ink small middle");
    }
  }
  return svg.ToInline();
}

}  // namespace pushid
