// ident: the picture of the forces on each person.
#include <algorithm>
#include <cmath>
#include <map>

#include "ident/figures/svg.h"
#include "ident/formations/formation_files.h"

namespace pushid {
namespace {

constexpr double kTop = 78, kHeight = 66, kGap = 8, kWidth = 1000;
constexpr double kLeft[] = {112, 574}, kPanelWidth = 406;
constexpr int kRows[] = {0, 2};  // of the generalized force: along x, about y
constexpr const char* kHeads[] = {"force along the push (N)", "torque about y (N m)"};

using Points = std::vector<std::pair<double, double>>;

// After Okabe and Ito: told apart by the colour-blind, on light and on dark paper.
// A part without a colour of its own is grey and dotted.
std::string PartColour(ForcePart part) {
  static const std::map<ForcePart, const char*> colours = {
      {ForcePart::kPush, "#d55e00"},
      {ForcePart::kTail, "#cc79a7"},
      {ForcePart::kFriction, "#e69f00"},
      {ForcePart::kBalance, "#56b4e9"},
      {ForcePart::kLinear, "#009e73"},
      {ForcePart::kInteraction, "#9333ea"},
      {ForcePart::kNetwork, "#6b7280;stroke-dasharray:7 2"}};
  const auto found = colours.find(part);
  return found == colours.end() ? "#999999;stroke-dasharray:2 2" : found->second;
}

std::string PartLook(ForcePart part) { return "stroke-width:1.5;stroke:" + PartColour(part); }

constexpr char kNetLook[] = "ink net";
constexpr double kSmallestRange = 10.0;  // N or N m, so that little is not blown up
constexpr double kNothing = 1e-6;        // N or N m
constexpr double kLegendStep = 104.0;    // pixels
constexpr double kLabelRoom = 6.0;       // pixels from a panel's edge to a tick with a label

class ForcesPicture {
 public:
  ForcesPicture(const FormationRun& run, const std::string& title, ForceScale scale)
      : run_(run),
        scale_(scale),
        parts_(ActingParts(run)),
        svg_(kWidth, kTop + (kHeight + kGap) * run.num_people() + 40, title) {
    svg_.Text(kLeft[0], 22, title, "ink bold");
  }

  SvgPicture Draw() {
    Legend();
    for (int n = 0; n < run_.num_people(); ++n) {
      svg_.Text(16, Top(n) + 0.5 * kHeight + 4, "person " + std::to_string(n), "ink small bold");
      for (int column : {0, 1}) Panel(n, column);
    }
    for (int column : {0, 1}) Axis(column);
    return svg_;
  }

 private:
  double Top(int person) const { return kTop + (kHeight + kGap) * person; }
  SvgScale Time(int column) const {
    return {0.0, run_.Seconds(run_.num_frames() - 1), kLeft[column], kLeft[column] + kPanelWidth};
  }

  // That of all panels of a column, or of one.
  std::pair<double, double> ScaleOf(int person, int column) const {
    if (scale_ == ForceScale::kOwn) return Range(person, column);
    std::pair<double, double> range = Range(0, column);
    for (int n = 1; n < run_.num_people(); ++n) {
      const auto [lowest, highest] = Range(n, column);
      range = {std::min(range.first, lowest), std::max(range.second, highest)};
    }
    return range;
  }

  // Lowest and highest of what a panel shows.
  std::pair<double, double> Range(int person, int column) const {
    const int row = kRows[column];
    double lowest = 0.0, highest = 0.0;
    const auto include = [&](double force) {
      lowest = std::min(lowest, force);
      highest = std::max(highest, force);
    };
    for (int t = 0; t < run_.num_frames(); ++t) {
      const NetForce<double>& force = run_.Force(person, t);
      include(force.Total()[row]);
      for (ForcePart part : parts_) include(force[part][row]);
    }
    return {lowest, highest};
  }

  void Legend() {
    double x = kLeft[0];
    const auto entry = [&](std::string_view name, const std::string& look) {
      svg_.Polyline({{x, 40}, {x + 18, 40}}, look);
      svg_.Text(x + 23, 44, name, "ink small");
      x += kLegendStep;
    };
    entry("net (the sum)", kNetLook);
    for (ForcePart part : parts_) entry(NameOf(part), PartLook(part));
    for (int column : {0, 1}) {
      const std::string own = scale_ == ForceScale::kOwn ? "; every panel has its own scale" : "";
      svg_.Text(kLeft[column], kTop - 12, kHeads[column] + own, "ink");
    }
  }

  void Ticks(int person, int column, const SvgScale& value) {
    std::vector<SvgLine> grid;
    for (double tick : value.Ticks(3)) {
      const double y = value(tick);
      const SvgLine across = {kLeft[column], y, kLeft[column] + kPanelWidth, y};
      if (tick == 0.0) {
        svg_.Lines({across}, "axis");
      } else {
        grid.push_back(across);
      }
      // Near the edge a label would run into the next panel's.
      if (y < Top(person) + kLabelRoom || y > Top(person) + kHeight - kLabelRoom) continue;
      svg_.Text(kLeft[column] - 5, y + 3.5, SvgNumber(tick), "faint small end");
    }
    svg_.Lines(grid, "grid");
  }

  void Panel(int person, int column) {
    const auto [least, most] = Range(person, column);
    if (most - least < kNothing) {
      const double y = Top(person) + 0.5 * kHeight;
      svg_.Line(kLeft[column], y, kLeft[column] + kPanelWidth, y, "axis");
      svg_.Text(kLeft[column] + 4, y - 5, "nothing", "faint small");
      return;
    }
    const auto [lowest, highest] = ScaleOf(person, column);  // with a fifth of air
    const double air = 0.1 * std::max(kSmallestRange, highest - lowest);
    const SvgScale value(lowest - air, highest + air, Top(person) + kHeight, Top(person));
    Ticks(person, column, value);
    const auto line = [&](auto force_at, const std::string& look) {
      Points points;
      bool acts = false;
      const SvgScale time = Time(column);
      for (int t = 0; t < run_.num_frames(); ++t) {
        const double force = force_at(run_.Force(person, t))[kRows[column]];
        acts = acts || force != 0.0;
        points.emplace_back(time(run_.Seconds(t)), value(force));
      }
      if (acts) svg_.Polyline(points, look);
    };
    // Thick and first, so that a part that is all of it shows on top.
    line([](const NetForce<double>& force) { return force.Total(); }, kNetLook);
    for (ForcePart part : parts_) {
      line([part](const NetForce<double>& force) { return force[part]; }, PartLook(part));
    }
  }

  void Axis(int column) {
    const double bottom = Top(run_.num_people()) - kGap;
    const SvgScale time = Time(column);
    svg_.Line(kLeft[column], bottom, kLeft[column] + kPanelWidth, bottom, "axis");
    for (double t : time.Ticks(6)) {
      svg_.Line(time(t), bottom, time(t), bottom + 4, "axis");
      svg_.Text(time(t), bottom + 16, SvgNumber(t), "ink small middle");
    }
    svg_.Text(kLeft[column] + 0.5 * kPanelWidth, bottom + 32, "time (s)", "ink middle");
  }

  const FormationRun& run_;
  const ForceScale scale_;
  const std::vector<ForcePart> parts_;
  SvgPicture svg_;
};

}  // namespace

SvgPicture ForcesPictureOf(const FormationRun& run, const std::string& title, ForceScale scale) {
  return ForcesPicture(run, title, scale).Draw();
}

std::string ForcesSvg(const FormationRun& run, const std::string& title, ForceScale scale) {
  return ForcesPictureOf(run, title, scale).ToString();
}

}  // namespace pushid
