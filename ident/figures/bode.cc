// ident: drawing Bode plots.
#include <algorithm>
#include <cmath>

#include "ident/figures/chart.h"

namespace pushid {
namespace {

constexpr char kErrorLook[] = "fill:none;stroke:#8a8f98;stroke-width:1.2";

// The multiple of 360 degrees away that is nearest.
double Nearest(double phase, double to) { return to + std::remainder(phase - to, 360.0); }

// Measured values with their errors over the model's curve.
Chart PanelOf(const std::string& title, const BodePlot& plot, const std::vector<double>& curve) {
  Chart chart{title, "frequency, Hz"};
  chart.logarithmic_x = true;
  if (!curve.empty()) chart.lines.push_back({{}, kPredictedLook});
  for (size_t i = 0; i < curve.size(); ++i) {
    chart.lines[0].points.emplace_back(std::log10(plot.hz[i]), curve[i]);
  }
  return chart;
}

void AddPoint(double hz, double value, double lower, double upper, Chart* chart) {
  const double x = std::log10(hz);
  if (upper > lower) chart->lines.push_back({{{x, lower}, {x, upper}}, kErrorLook});
  chart->lines.push_back({{{x, value}}, kMeasuredLook, true});
}

}  // namespace

void Unwrap(BodePlot* plot) {
  for (size_t i = 1; i < plot->phase.size(); ++i) {
    plot->phase[i] = Nearest(plot->phase[i], plot->phase[i - 1]);
  }
  for (size_t i = 0; i < plot->measured.size(); ++i) {
    BodePoint& point = plot->measured[i];
    if (!plot->hz.empty()) {
      const auto next = std::lower_bound(plot->hz.begin(), plot->hz.end(), point.hz);
      const size_t at = std::min<size_t>(next - plot->hz.begin(), plot->hz.size() - 1);
      point.phase = Nearest(point.phase, plot->phase[at]);
    } else if (i > 0) {
      point.phase = Nearest(point.phase, plot->measured[i - 1].phase);
    }
  }
}

Figure BodeFigure(const BodePlot& plot) {
  std::vector<double> log_gain;
  for (double gain : plot.gain) log_gain.push_back(std::log10(gain));
  Chart gain = PanelOf("gain, " + plot.gain_unit, plot, log_gain);
  Chart phase = PanelOf("phase, degrees", plot, plot.phase);
  Chart coherence = PanelOf("coherence", plot, {});
  gain.logarithmic_y = true;
  coherence.y_from = 0.0;
  coherence.y_to = 1.05;
  double lowest = INFINITY, highest = -INFINITY;
  const auto add = [&](double log) {
    lowest = std::min(lowest, log);
    highest = std::max(highest, log);
  };
  for (double log : log_gain) add(log);
  for (const BodePoint& point : plot.measured) {
    const double lower = std::log10(point.gain_lower), upper = std::log10(point.gain_upper);
    add(lower), add(upper);
    AddPoint(point.hz, std::log10(point.gain), lower, upper, &gain);
    AddPoint(point.hz, point.phase, point.phase - point.phase_error,
             point.phase + point.phase_error, &phase);
    AddPoint(point.hz, point.coherence, 0.0, 0.0, &coherence);
  }
  gain.y_from = std::floor(lowest);  // a power of ten at both ends
  gain.y_to = std::max(std::ceil(highest), *gain.y_from + 1.0);
  Figure figure;
  figure.legend = {{"measured, one standard error", kErrorLook}};
  if (!plot.hz.empty()) figure.legend.push_back({"model", kPredictedLook});
  figure.panels = {gain, phase, coherence};
  return figure;
}

}  // namespace pushid
