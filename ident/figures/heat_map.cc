// ident: drawing heat maps.
#include "ident/figures/heat_map.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/svg.h"

namespace pushid {
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
