// ident: colours of numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ident/figures/svg.h"

namespace pushid {
namespace {

using Rgb = std::array<double, 3>;

// Between stops of even distance; at in [0, 1], clamped.
template <size_t N>
std::string Blend(const std::array<Rgb, N>& stops, double at) {
  const double place = std::clamp(at, 0.0, 1.0) * (N - 1);
  const size_t low = std::min(static_cast<size_t>(place), N - 2);
  std::array<int, 3> rgb{};
  for (int i = 0; i < 3; ++i) {
    const double from = stops[low][i], to = stops[low + 1][i];
    rgb[i] = static_cast<int>(std::lround(from + (place - low) * (to - from)));
  }
  char text[32];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
  return text;
}

}  // namespace

std::string ColourOf(double fraction) {
  static constexpr std::array<Rgb, 6> kStops = {
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  return Blend(kStops, fraction);
}

std::string SignedColourOf(double fraction) {
  static constexpr std::array<Rgb, 7> kStops = {{{127, 59, 8},
                                                 {217, 120, 20},
                                                 {250, 190, 120},
                                                 {244, 244, 244},
                                                 {146, 197, 222},
                                                 {50, 120, 180},
                                                 {5, 48, 97}}};
  return Blend(kStops, 0.5 + 0.5 * fraction);
}

}  // namespace pushid
