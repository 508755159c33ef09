// ident: a picture of what pushid-inspect found.
#include "ident/report/inspection_svg.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kWidth = 760, kLeft = 70, kRight = 140, kTop = 44;
constexpr double kPanel = 170, kGap = 58;
constexpr double kBar = 12;                   // height of a point's bar
constexpr double kFeetPanel = 2 * kBar + 40;  // with the gap below
constexpr std::size_t kMostBars = 60;
constexpr std::size_t kMostPoints = 1500;  // of a line: more than there are pixels

const char* const kColours[] = {"#3b6fb5", "#d1762c", "#3f8f5b", "#a8476a", "#7a6cc0", "#8a7a2e"};

struct Line {
  std::string name;
  double rate_hz;
  std::vector<double> values;
};

class Picture {
 public:
  explicit Picture(const Inspection& found)
      : found_(found), svg_(kWidth, Height(found), found.path) {
    svg_.Text(kLeft - 50, 22, found.path + ": " + found.format, "ink bold");
  }

  std::string Draw() {
    if (HasHip(found_)) {
      std::vector<Line> lines;
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const Eigen::Vector3d& position : found_.hip) values.push_back(position[axis]);
        lines.push_back({std::string(1, "xyz"[axis]), found_.rate_hz, values});
      }
      Panel("the hip, m from its first place", lines, found_.onset_frame / found_.rate_hz);
      if (found_.steps) Feet();
    }
    if (!found_.seen.empty()) Bars();
    if (!found_.forces.empty()) {
      std::vector<Line> lines;
      for (const InspectedSignal& force : found_.forces) {
        lines.push_back({force.name, force.rate_hz, force.values});
      }
      Panel("forces, N", lines, -1.0);
    }
    return svg_.ToString();
  }

 private:
  static bool HasHip(const Inspection& found) { return !found.hip.empty() && found.rate_hz > 0.0; }

  static double Height(const Inspection& found) {
    const double bars = static_cast<double>(std::min(kMostBars, found.seen.size()));
    return kTop + (HasHip(found) ? kPanel + kGap : 0.0) +
           (HasHip(found) && found.steps ? kFeetPanel : 0.0) +
           (found.seen.empty() ? 0.0 : bars * kBar + kGap) +
           (found.forces.empty() ? 0.0 : kPanel + kGap);
  }

  void Panel(const std::string& title, const std::vector<Line>& lines, double mark_s) {
    double lowest = 0.0, highest = 1e-9, end = 1e-9;
    for (const Line& line : lines) {
      end = std::max(end, static_cast<double>(line.values.size()) / line.rate_hz);
      for (double value : line.values) {
        if (!std::isfinite(value)) continue;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
      }
    }
    const SvgScale across(0.0, end, kLeft, kWidth - kRight);
    const SvgScale up(lowest, highest, top_ + kPanel, top_ + 12);
    svg_.Text(kLeft, top_, title, "ink");
    for (double tick : up.Ticks(4)) {
      svg_.Line(kLeft, up(tick), kWidth - kRight, up(tick), "grid");
      svg_.Text(kLeft - 6, up(tick) + 4, Rounded(tick, 3), "axis end small");
    }
    for (double tick : across.Ticks(6)) {
      svg_.Text(across(tick), top_ + kPanel + 16, Rounded(tick, 3), "axis middle small");
    }
    svg_.Text(kWidth - kRight, top_ + kPanel + 30, "time (s)", "axis end small");
    if (mark_s > 0.0) {
      svg_.Line(across(mark_s), top_ + 12, across(mark_s), top_ + kPanel, "axis");
      svg_.Text(across(mark_s) + 4, top_ + 22, "2 cm", "faint small");
    }
    for (std::size_t i = 0; i < lines.size(); ++i) Curve(lines[i], kColours[i % 6], i, across, up);
    top_ += kPanel + kGap;
  }

  // Broken where values are missing.
  void Curve(const Line& line, const std::string& colour, std::size_t index, const SvgScale& across,
             const SvgScale& up) {
    const std::size_t stride = line.values.size() / kMostPoints + 1;
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < line.values.size(); i += stride) {
      if (std::isfinite(line.values[i])) {
        points.emplace_back(across(static_cast<double>(i) / line.rate_hz), up(line.values[i]));
      } else {
        svg_.Polyline(points, "stroke-width:1.5;stroke:" + colour);
        points.clear();
      }
    }
    svg_.Polyline(points, "stroke-width:1.5;stroke:" + colour);
    svg_.Text(kWidth - kRight + 10, top_ + 24 + 15 * static_cast<double>(index), line.name,
              "font-size:10px;fill:" + colour);
  }

  // On the hip's axis of time.
  void Feet() {
    const double frames = static_cast<double>(found_.hip.size());
    const SvgScale across(0.0, frames, kLeft, kWidth - kRight);
    svg_.Text(kLeft, top_, "feet off the ground", "ink");
    double y = top_ + 10;
    for (Foot foot : kFeet) {
      svg_.Line(kLeft, y + kBar - 2, kWidth - kRight, y + kBar - 2, "grid");
      for (const FootStep& step : found_.steps->steps) {
        if (step.foot != foot) continue;
        const double from = across(step.lift_off), to = across(step.landing);
        svg_.Rect({from, y, to - from, kBar - 2}, std::string("fill:") + kColours[0],
                  StepsText({{step}}, found_.rate_hz));
      }
      svg_.Text(kWidth - kRight + 6, y + kBar - 2, NameOf(foot), "faint small");
      y += kBar;
    }
    top_ += kFeetPanel;
  }

  void Bars() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < found_.seen.size(); ++i) order.push_back(i);
    const auto hidden = [this](std::size_t i) {
      return std::count(found_.seen[i].begin(), found_.seen[i].end(), false);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return hidden(a) > hidden(b); });
    order.resize(std::min(order.size(), kMostBars));
    svg_.Text(kLeft, top_, "frames in which each point was seen", "ink");
    const double frames = static_cast<double>(found_.seen[0].size());
    const SvgScale across(0.0, std::max(1.0, frames), kLeft, kWidth - kRight);
    double y = top_ + 10;
    for (std::size_t i : order) {
      const std::vector<bool>& seen = found_.seen[i];
      for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        end = begin;
        while (end < seen.size() && seen[end] == seen[begin]) ++end;
        const double from = across(static_cast<double>(begin)),
                     to = across(static_cast<double>(end));
        svg_.Rect({from, y, to - from, kBar - 2}, seen[begin] ? "fill:#9fb8d6" : "fill:#d1762c",
                  found_.point_names[i] + (seen[begin] ? " seen" : " hidden") + ", frames " +
                      std::to_string(begin) + " to " + std::to_string(end - 1));
      }
      svg_.Text(kWidth - kRight + 6, y + kBar - 2, found_.point_names[i], "faint small");
      y += kBar;
    }
    top_ = y + kGap - 10;
  }

  const Inspection& found_;
  SvgPicture svg_;
  double top_ = kTop;
};

}  // namespace

std::string InspectionSvg(const Inspection& inspection) { return Picture(inspection).Draw(); }

}  // namespace pushid
