// ident: drawing Bode plots.
#include "ident/figures/bode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ident/figures/chart.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr double kBodeWidth = 640, kBodeLeft = 64, kBodeRight = 628;
constexpr double kGainHeight = 170, kPhaseHeight = 150, kCoherenceHeight = 60, kBetween = 26;
constexpr double kDot = 2.6;  // pixels
constexpr char kErrorLook[] = "stroke:#8a8f98;stroke-width:1.2";
constexpr char kDotLook[] = "ink";

// The multiple of 360 degrees away that is nearest.
double Nearest(double phase, double to) { return to + std::remainder(phase - to, 360.0); }

struct BodeRange {
  double from = INFINITY, to = -INFINITY;

  void Add(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  // At least so wide, with some air.
  BodeRange Widened(double least) const {
    if (from > to) return {0.0, 1.0};
    const double air = std::max(0.06 * (to - from), 0.5 * (least - (to - from)));
    return {from - air, to + air};
  }
};

std::string PowerText(int power) {
  return -2 <= power && power <= 3 ? SvgNumber(std::pow(10.0, power))
                                   : "1e" + std::to_string(power);
}

// A panel over the common axis of frequencies; y on a linear scale (log10 of gains).
class BodePanel {
 public:
  BodePanel(const SvgScale& x, const BodeRange& range, double top, double height, SvgPicture* svg)
      : x_(x),
        y_(range.from, range.to, top + height, top),
        range_(range),
        top_(top),
        bottom_(top + height),
        svg_(*svg) {}

  void Frame(const std::string& title, const std::vector<double>& ticks) {
    svg_.Text(kBodeLeft, top_ - 7, title, "ink bold");
    std::vector<SvgLine> lines;
    for (double hz : ticks)
      lines.push_back({x_(std::log10(hz)), top_, x_(std::log10(hz)), bottom_});
    svg_.Lines(lines, "grid");
    svg_.Lines({{kBodeLeft, bottom_, kBodeRight, bottom_}}, "axis");
  }
  // A line across, with what it is called.
  void Level(double value, const std::string& name) {
    if (value < range_.from || value > range_.to) return;
    svg_.Line(kBodeLeft, y_(value), kBodeRight, y_(value), "grid");
    svg_.Text(kBodeLeft - 5, y_(value) + 3.5, name, "faint small end");
  }
  void Curve(const std::vector<double>& hz, const std::vector<double>& values) {
    ChartPoints points;
    for (size_t i = 0; i < hz.size(); ++i)
      points.emplace_back(x_(std::log10(hz[i])), y_(values[i]));
    svg_.Polyline(points, kPredictedLook);
  }
  void Point(const BodePoint& point, double value, double lower, double upper) {
    const double x = x_(std::log10(point.hz));
    const auto inside = [this](double y) { return std::clamp(y_(y), top_, bottom_); };
    if (upper > lower) svg_.Line(x, inside(lower), x, inside(upper), kErrorLook);
    svg_.Circle(x, inside(value), kDot, kDotLook, point.tooltip);
  }

 private:
  const SvgScale& x_;
  SvgScale y_;
  BodeRange range_;
  double top_, bottom_;
  SvgPicture& svg_;
};

// 1, 2 and 5 times powers of ten.
std::vector<double> FrequencyTicks(const BodeRange& log_hz) {
  std::vector<double> ticks;
  for (int power = static_cast<int>(std::floor(log_hz.from)); power <= std::ceil(log_hz.to);
       ++power) {
    for (double first : {1.0, 2.0, 5.0}) {
      const double tick = first * std::pow(10.0, power);
      if (std::log10(tick) >= log_hz.from && std::log10(tick) <= log_hz.to) ticks.push_back(tick);
    }
  }
  return ticks;
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

std::string DrawBode(const BodePlot& plot) {
  BodeRange log_hz, log_gain, phase;
  for (const BodePoint& point : plot.measured) {
    log_hz.Add(std::log10(point.hz));
    for (double gain : {point.gain_lower, point.gain, point.gain_upper}) {
      log_gain.Add(std::log10(gain));
    }
    phase.Add(point.phase - point.phase_error);
    phase.Add(point.phase + point.phase_error);
  }
  for (size_t i = 0; i < plot.hz.size(); ++i) {
    log_hz.Add(std::log10(plot.hz[i]));
    log_gain.Add(std::log10(plot.gain[i]));
    phase.Add(plot.phase[i]);
  }
  log_hz = log_hz.Widened(0.3);
  log_gain = log_gain.Widened(1.0);
  phase = phase.Widened(90.0);
  const double gain_top = 48, phase_top = gain_top + kGainHeight + kBetween;
  const double coherence_top = phase_top + kPhaseHeight + kBetween;
  const double bottom = coherence_top + kCoherenceHeight;
  SvgPicture svg(kBodeWidth, bottom + 38, plot.title);
  std::vector<LegendEntry> legend = {{"measured, one standard error", kErrorLook}};
  if (!plot.hz.empty()) legend.push_back({"model", kPredictedLook});
  DrawLegend(legend, kBodeLeft, 16, &svg);
  const SvgScale x(log_hz.from, log_hz.to, kBodeLeft, kBodeRight);
  const std::vector<double> ticks = FrequencyTicks(log_hz);

  BodePanel gains(x, log_gain, gain_top, kGainHeight, &svg);
  gains.Frame("gain, " + plot.gain_unit, ticks);
  for (int power = static_cast<int>(std::ceil(log_gain.from)); power <= log_gain.to; ++power) {
    gains.Level(power, PowerText(power));
  }
  std::vector<double> log_curve;
  for (double gain : plot.gain) log_curve.push_back(std::log10(gain));
  gains.Curve(plot.hz, log_curve);

  BodePanel phases(x, phase, phase_top, kPhaseHeight, &svg);
  phases.Frame("phase, degrees", ticks);
  const double step = phase.to - phase.from > 400.0 ? 180.0 : 90.0;
  for (double level = std::ceil(phase.from / step) * step; level <= phase.to; level += step) {
    phases.Level(level, SvgNumber(level));
  }
  phases.Curve(plot.hz, plot.phase);

  BodePanel coherences(x, {0.0, 1.05}, coherence_top, kCoherenceHeight, &svg);
  coherences.Frame("coherence", ticks);
  for (double level : {0.0, 0.5, 1.0}) coherences.Level(level, SvgNumber(level));
  for (const BodePoint& point : plot.measured) {
    gains.Point(point, std::log10(point.gain), std::log10(point.gain_lower),
                std::log10(point.gain_upper));
    phases.Point(point, point.phase, point.phase - point.phase_error,
                 point.phase + point.phase_error);
    coherences.Point(point, point.coherence, 0.0, 0.0);
  }
  double free_from = -INFINITY;
  for (double tick : ticks) {
    const double at = x(std::log10(tick));
    if (at < free_from) continue;
    free_from = at + 30;
    svg.Text(at, bottom + 15, SvgNumber(tick), "ink small middle");
  }
  svg.Text(0.5 * (kBodeLeft + kBodeRight), bottom + 30, "frequency, Hz", "faint small middle");
  return svg.ToInline();
}

}  // namespace pushid
