// ident: values and intervals in words.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/problem/behaviour_text.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr char kUndetermined[] = "undetermined";
constexpr double kOpenFactor = 100.0;  // to either side
constexpr double kOpenSize = 1e6;      // of intervals that contain zero, in units of the value

}  // namespace

double ShownEnd(double value, double end, double other_end) {
  const double open = end < value ? -INFINITY : INFINITY;
  if (!std::isfinite(end)) return end;
  const double factor = end / value;
  if (value * end <= 0.0 || value * other_end <= 0.0) {
    return std::abs(end) > kOpenSize * std::max(1.0, std::abs(value)) ? open : end;
  }
  if (factor > kOpenFactor) return open;
  const bool wide = std::abs(std::log(end / other_end)) > 2.0 * std::log(kOpenFactor);
  return wide && factor < 1.0 / kOpenFactor ? open : end;
}

std::string IntervalText(double value, double lower, double upper) {
  const double from = ShownEnd(value, lower, upper), to = ShownEnd(value, upper, lower);
  if (!std::isfinite(from) && !std::isfinite(to)) return kUndetermined;
  const auto side = [](double end) {
    return std::isfinite(end) ? Rounded(end, 4) : std::string("open");
  };
  return "[" + side(from) + ", " + side(to) + "]";
}

namespace {

// How a derived gain reads; rates as their time constant.
struct GainWords {
  const char *derived, *name, *unit;
  bool inverse;
};
constexpr GainWords kGainWords[] = {
    {"Kp_theta/(m g l)", "ankle stiffness",
     " times m g l (1 is just enough to hold a pendulum upright)", false},
    {"Kp_theta/(M g l)", "ankle stiffness",
     " times M g l (1.06 is just enough to hold a body upright)", false},
    {"Kp_phi/(M g l)", "to the side", " times M g l", false},
    {"Kd_theta/(M l^2)", "damping of the lean with a time constant of", " s", true},
    {"Kp_phi/(m g l)", "to the side", " times m g l", false},
    {"Kd_theta/(m l^2)", "damping of the lean with a time constant of", " s", true},
    {"c_x/M", "friction of the feet with a time constant of", " s", true},
};

std::string GainText(const GainWords& words, const Combination& gain) {
  const bool held = gain.standard_error == 0.0;
  const bool known = held || IntervalText(gain.value, gain.lower95, gain.upper95) != kUndetermined;
  const std::string value = Rounded(words.inverse ? 1.0 / gain.value : gain.value, 2);
  return words.name + std::string(" ") + value + words.unit +
         (held    ? " (held)"
          : known ? ""
                  : " (undetermined)");
}

}  // namespace

std::string GainsText(const FitResult& result) {
  std::string text;
  for (const GainWords& words : kGainWords) {
    for (const Combination& gain : result.derived) {
      if (gain.name != words.derived || !(gain.value > 0.0)) continue;
      text += (text.empty() ? "" : ", ") + GainText(words, gain);
    }
  }
  return text.empty() ? "" : Capitalized(text) + ".";
}

}  // namespace pushid
