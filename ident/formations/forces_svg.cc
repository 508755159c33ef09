// ident: the picture of the forces on each person.
#include <algorithm>
#include <cmath>
#include <map>

#include "ident/figures/chart.h"
#include "ident/formations/formation_files.h"

namespace pushid {
namespace {

constexpr double kForcesWidth = 1000, kForcesHeight = 120, kForcesPanel = 500;
constexpr int kRows[] = {0, 2};  // of the generalized force: along x, about y
constexpr const char* kForceHeads[] = {"force along the push, N", "torque about y, N m"};

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

std::string PartLook(ForcePart part) {
  return "fill:none;stroke-width:1.5;stroke:" + PartColour(part);
}

constexpr char kNetLook[] = "ink net";
constexpr double kSmallestRange = 10.0;  // N or N m, so that little is not blown up
constexpr double kNothing = 1e-6;        // N or N m

struct ForceRange {
  double lowest = 0.0, highest = 0.0;

  void Add(double force) {
    lowest = std::min(lowest, force);
    highest = std::max(highest, force);
  }
};

// Of what a panel shows.
ForceRange RangeOf(const FormationRun& run, const std::vector<ForcePart>& parts, int person,
                   int row) {
  ForceRange range;
  for (int t = 0; t < run.num_frames(); ++t) {
    const NetForce<double>& force = run.Force(person, t);
    range.Add(force.Total()[row]);
    for (ForcePart part : parts) range.Add(force[part][row]);
  }
  return range;
}

// The net force thick and first, so that a part that is all of it shows on top.
Chart ForceChart(const FormationRun& run, const std::vector<ForcePart>& parts, int person, int row,
                 const ForceRange& scale) {
  Chart chart;
  chart.x_label = "time, s";
  const double air = 0.1 * std::max(kSmallestRange, scale.highest - scale.lowest);
  chart.y_from = scale.lowest - air;
  chart.y_to = scale.highest + air;
  const auto line = [&](auto force_at, const std::string& look) {
    ChartLine drawn{{}, look};
    bool acts = false;
    for (int t = 0; t < run.num_frames(); ++t) {
      const double force = force_at(run.Force(person, t))[row];
      acts = acts || force != 0.0;
      drawn.points.emplace_back(run.Seconds(t), force);
    }
    if (acts) chart.lines.push_back(drawn);
  };
  line([](const NetForce<double>& force) { return force.Total(); }, kNetLook);
  for (ForcePart part : parts) {
    line([part](const NetForce<double>& force) { return force[part]; }, PartLook(part));
  }
  return chart;
}

}  // namespace

Figure ForcesFigure(const FormationRun& run, ForceScale scale) {
  const std::vector<ForcePart> parts = ActingParts(run);
  Figure figure;
  figure.legend = {{"net (the sum)", kNetLook}};
  for (ForcePart part : parts) figure.legend.push_back({std::string(NameOf(part)), PartLook(part)});
  ForceRange shared[2];
  for (int n = 0; n < run.num_people(); ++n) {
    for (int column : {0, 1}) {
      const ForceRange range = RangeOf(run, parts, n, kRows[column]);
      shared[column].Add(range.lowest);
      shared[column].Add(range.highest);
    }
  }
  for (int n = 0; n < run.num_people(); ++n) {
    for (int column : {0, 1}) {
      const ForceRange own = RangeOf(run, parts, n, kRows[column]);
      Chart chart = ForceChart(run, parts, n, kRows[column],
                               scale == ForceScale::kOwn ? own : shared[column]);
      chart.title = kForceHeads[column];
      if (run.num_people() > 1) chart.title = "person " + std::to_string(n) + ": " + chart.title;
      if (own.highest - own.lowest < kNothing) chart.y_label = "nothing";
      figure.panels.push_back(chart);
    }
  }
  return figure;
}

std::string ForcesSvg(const FormationRun& run, const std::string& title, ForceScale scale) {
  Figure figure = ForcesFigure(run, scale);
  for (Chart& panel : figure.panels) {
    panel.width = kForcesPanel;
    panel.height = kForcesHeight;
  }
  figure.heading = title + (scale == ForceScale::kOwn ? "; every panel has its own scale" : "");
  return DrawFigure(figure, kForcesWidth, title).ToString();
}

}  // namespace pushid
