// ident: the picture of accuracy against settling.
#include "ident/validation/frontier_svg.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"
#include "ident/problem/behaviour.h"

namespace pushid {
namespace {

constexpr double kWidth = 760, kHeight = 460;
constexpr double kLeft = 70, kRight = 560, kTop = 40, kBottom = 400;
constexpr double kLabelStep = 15;  // pixels between labels

struct Label {
  double x, y;  // of the point
  std::string text;
};

// To the right of the picture, in the order of the points, no two on top of each other.
void DrawLabels(std::vector<Label> labels, SvgPicture* svg) {
  std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
  double free = kTop;
  for (const Label& label : labels) {
    const double y = std::max(free, label.y);
    svg->Line(label.x + 6, label.y, kRight + 8, y, "stroke:#999999;stroke-width:0.5");
    svg->Text(kRight + 12, y + 4, label.text, "ink small");
    free = y + kLabelStep;
  }
}

void DrawAxes(const SvgScale& across, const SvgScale& up, SvgPicture* svg) {
  svg->Line(kLeft, kBottom, kRight, kBottom, "axis");
  svg->Line(kLeft, kTop, kLeft, kBottom, "axis");
  for (double tick : across.Ticks(6)) {
    svg->Line(across(tick), kTop, across(tick), kBottom, "grid");
    svg->Text(across(tick), kBottom + 18, Rounded(tick, 3), "ink middle small");
  }
  for (double tick : up.Ticks(6)) {
    svg->Line(kLeft, up(tick), kRight, up(tick), "grid");
    svg->Text(kLeft - 8, up(tick) + 4, Rounded(tick, 3), "ink end small");
  }
  svg->Text((kLeft + kRight) / 2, kBottom + 42,
            "fastest cart two seconds after a push, any fold and settling simulation (m/s)",
            "ink middle");
  svg->Text(kLeft, kTop - 14, "hipADE (m), with its standard error", "ink");
}

}  // namespace

std::string FrontierSvg(const std::vector<CrossValidation>& validations) {
  double fastest = 2.0 * kSettledSpeed, lowest = 1e9, highest = 0.0;
  for (const CrossValidation& v : validations) {
    if (v.fits == 0) continue;
    const MeanScore& mean = v.summary.mean;
    fastest = std::max(fastest, 1.1 * v.slowest_to_settle);
    lowest = std::min(lowest, mean.hip_ade - 1.2 * mean.error.hip_ade);
    highest = std::max(highest, mean.hip_ade + 1.2 * mean.error.hip_ade);
  }
  SvgPicture svg(kWidth, kHeight, "accuracy against settling");
  if (highest <= lowest) {
    svg.Text(kLeft, kTop, "no model was fitted");
    return svg.ToString();
  }
  const SvgScale across(0.0, fastest, kLeft, kRight), up(lowest, highest, kBottom, kTop);
  svg.Rect({kLeft, kTop, across(kSettledSpeed) - kLeft, kBottom - kTop},
           "fill:#009e73;opacity:0.12");
  DrawAxes(across, up, &svg);
  svg.Text(kLeft + 6, kTop + 14, "settled", "ink small");
  std::vector<Label> labels;
  for (const CrossValidation& v : validations) {
    if (v.fits == 0) continue;
    const MeanScore& mean = v.summary.mean;
    const double x = across(v.slowest_to_settle), y = up(mean.hip_ade);
    svg.Line(x, up(mean.hip_ade - mean.error.hip_ade), x, up(mean.hip_ade + mean.error.hip_ade),
             "stroke:#0072b2;stroke-width:1.5");
    svg.Circle(x, y, 4.5, v.settling == v.fits ? "fill:#009e73" : "fill:#d55e00");
    labels.push_back({x, y, v.predictor});
  }
  DrawLabels(std::move(labels), &svg);
  return svg.ToString();
}

}  // namespace pushid
