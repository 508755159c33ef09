// ident: a picture of what pushid-inspect found.
#include "ident/report/inspection_svg.h"

#include <algorithm>
#include <cmath>

#include "ident/figures/chart.h"

namespace pushid {
namespace {

constexpr double kInspectionWidth = 1000;
constexpr std::size_t kMostBars = 60;
constexpr std::size_t kMostPoints = 1500;  // of a line: more than there are pixels

// Broken where values are missing.
Chart SignalChart(const std::string& title, double rate_hz, const std::vector<double>& values) {
  Chart chart{title, "time, s"};
  chart.lines.push_back({{}, kMeasuredLook});
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostPoints + 1) {
    if (std::isfinite(values[i])) {
      chart.lines.back().points.emplace_back(static_cast<double>(i) / rate_hz, values[i]);
    } else if (!chart.lines.back().points.empty()) {
      chart.lines.push_back({{}, kMeasuredLook});
    }
  }
  return chart;
}

void AddHip(const Inspection& found, Figure* figure) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& position : found.hip) values.push_back(position[axis]);
    Chart chart =
        SignalChart(std::string("hip ") + "xyz"[axis] + " displacement, m", found.rate_hz, values);
    if (found.onset_frame > 0) {
      chart.marks = {found.onset_frame / found.rate_hz};
      chart.x_label = "time, s (line: the hip has moved by 2 cm)";
    }
    for (Foot foot : kFeet) {
      if (!found.steps) continue;
      ChartLane lane{NameOf(foot), {}, kLiftedLook};
      for (const FootStep& step : found.steps->steps) {
        if (step.foot != foot) continue;
        lane.bars.emplace_back(step.lift_off / found.rate_hz, step.landing / found.rate_hz);
      }
      chart.lanes.push_back(lane);
    }
    figure->panels.push_back(chart);
  }
  if (found.steps) figure->legend = {{"foot off the ground", kLiftedLook}};
}

// Bars where points were seen, those that were hidden most first.
Chart SeenChart(const Inspection& found) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < found.seen.size(); ++i) order.push_back(i);
  const auto hidden = [&found](std::size_t i) {
    return std::count(found.seen[i].begin(), found.seen[i].end(), false);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return hidden(a) > hidden(b); });
  order.resize(std::min(order.size(), kMostBars));
  Chart chart{"points seen (blue), by frame"};
  for (std::size_t i : order) {
    const std::vector<bool>& seen = found.seen[i];
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
      end = begin;
      while (end < seen.size() && seen[end] == seen[begin]) ++end;
      chart.bars.push_back(
          {static_cast<double>(chart.y_categories.size()), static_cast<double>(begin),
           static_cast<double>(end), seen[begin] ? "fill:#9fb8d6" : "fill:#d1762c",
           found.point_names[i] + (seen[begin] ? " seen" : " hidden") + ", frames " +
               std::to_string(begin) + " to " + std::to_string(end - 1)});
    }
    chart.y_categories.push_back(found.point_names[i]);
  }
  return chart;
}

}  // namespace

std::string InspectionSvg(const Inspection& found) {
  Figure figure;
  figure.heading = found.path + ": " + found.format;
  if (!found.hip.empty() && found.rate_hz > 0.0) AddHip(found, &figure);
  for (const InspectedSignal& force : found.forces) {
    figure.panels.push_back(SignalChart(force.name + ", N", force.rate_hz, force.values));
  }
  if (!found.seen.empty()) figure.panels.push_back(SeenChart(found));
  return DrawFigure(figure, kInspectionWidth, found.path).ToString();
}

}  // namespace pushid
