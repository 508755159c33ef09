#include "ident/figures/svg.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

namespace pushid {
namespace {

// Viewers that do not know prefers-color-scheme show the light picture.
constexpr char kStyle[] =
    "text{font:12px "
    "system-ui,Helvetica,Arial,sans-serif}.small{font-size:11px}.bold{font-weight:600}"
    ".middle{text-anchor:middle}.end{text-anchor:end}"
    ".paper{fill:#fff}.ink,.axis{fill:#222}.faint{fill:#666}"
    "line,path{fill:none;stroke-linejoin:round}"
    "line.axis,path.axis,path.ink{stroke:#222;fill:none}path.ink{stroke-width:1.4}"
    "line.grid,path.grid{stroke:#ddd}rect{shape-rendering:crispEdges}.ring{fill:none;stroke:#222}"
    "path.net{stroke-width:3}"
    ".predicted{stroke-width:1.8;stroke:#3b82f6}"
    ".band{stroke:none;fill:#3b82f6}path.band{fill:#3b82f6}.wide{fill-opacity:.16}"
    ".narrow{fill-opacity:.26}.lifted{fill:#8a8f98}"
    "@media(prefers-color-scheme:dark){.paper{fill:#15181c}.ink,.axis{fill:#e8e8e8}"
    ".faint{fill:#a0a0a0}line.axis,path.axis,path.ink{stroke:#e8e8e8;fill:none}"
    "line.grid,path.grid{stroke:#3a3f46}.ring{stroke:#e8e8e8}}";

using Points = std::vector<std::pair<double, double>>;

constexpr double kTolerance = 0.4;  // pixels

// Simplifies a line (Douglas and Peucker): keeps the farthest point of a stretch while it is too
// far from the chord.
void Thin(const Points& points, size_t first, size_t last, std::vector<bool>* kept) {
  const auto [x1, y1] = points[first];
  const double dx = points[last].first - x1, dy = points[last].second - y1;
  const double length = std::hypot(dx, dy);
  double farthest = kTolerance;
  size_t at = first;
  for (size_t i = first + 1; i < last; ++i) {
    const double px = points[i].first - x1, py = points[i].second - y1;
    const double off = length > 0.0 ? std::abs(px * dy - py * dx) / length : std::hypot(px, py);
    if (off > farthest) {
      farthest = off;
      at = i;
    }
  }
  if (at == first) return;
  (*kept)[at] = true;
  Thin(points, first, at, kept);
  Thin(points, at, last, kept);
}

// Coordinates are most of a page, so they are tenths of a pixel, and relative to the point before.
class PathData {
 public:
  void MoveTo(double x, double y) {
    text_ += 'M';
    x_ = y_ = 0;
    Step(x, y);
    moved_ = true;
  }
  void LineTo(double x, double y) {
    if (moved_) text_ += 'l';
    moved_ = false;
    Step(x, y);
  }
  const std::string& text() const { return text_; }

 private:
  void Step(double x, double y) {
    const long to_x = std::lround(10.0 * x), to_y = std::lround(10.0 * y);
    Append(to_x - x_);
    Append(to_y - y_);
    x_ = to_x;
    y_ = to_y;
  }
  // A letter or a minus sign separates numbers as well as a space does.
  void Append(long tenths) {
    const bool first = std::isalpha(static_cast<unsigned char>(text_.back()));
    text_ += tenths < 0 ? "-" : first ? "" : " ";
    const long size = std::labs(tenths);
    if (size >= 10 || size == 0) text_ += std::to_string(size / 10);
    if (size % 10 != 0) (text_ += '.') += static_cast<char>('0' + size % 10);
  }

  std::string text_;
  bool moved_ = false;  // by the last command
  long x_ = 0, y_ = 0;
};

// Writes "-0.5" with U+2212 for a hyphen before a digit at the start of a word.
std::string WithMinusSigns(std::string_view text) {
  std::string with;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool starts = i == 0 || text[i - 1] == ' ' || text[i - 1] == '(' || text[i - 1] == '[';
    const bool number = i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    if (text[i] == '-' && starts && number) {
      with += "\u2212";
    } else {
      with += text[i];
    }
  }
  return with;
}

// Attributes of numbers.
std::string Numbers(std::initializer_list<std::pair<const char*, double>> numbers) {
  std::string attributes;
  for (const auto& [name, value] : numbers) {
    attributes += std::string(" ") + name + "=\"" + SvgNumber(value) + '"';
  }
  return attributes;
}

using Rgb = std::array<double, 3>;

// A colour between stops of even distance; at in [0, 1], clamped.
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

std::string_view SvgStyle() { return kStyle; }

std::string EscapeXml(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr const char* kEntities[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string escaped;
  for (const char c : text) {
    if (const size_t at = kSpecial.find(c); at != std::string_view::npos) {
      escaped += kEntities[at];
    } else {
      escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

std::string SvgNumber(double value) {
  char number[64];
  std::snprintf(number, sizeof number, "%.2f", value);
  std::string text = number;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

SvgPicture::SvgPicture(double width, double height, std::string_view title)
    : width_(width), height_(height) {
  body_ = "<title>" + EscapeXml(title) + "</title>\n";
  Rect({0, 0, width, height}, "paper");
}

void SvgPicture::Element(const std::string& name, const std::string& before, std::string_view look,
                         const std::string& after, const std::string& content) {
  const bool css = look.find(':') != std::string_view::npos;
  body_ += "<" + name + before + (css ? " style=\"" : " class=\"") + EscapeXml(look) + '"' + after +
           (content.empty() ? "/>\n" : ">" + content + "</" + name + ">\n");
}

void SvgPicture::Rect(const SvgBox& box, std::string_view look, std::string_view tooltip) {
  Element("rect",
          Numbers({{"x", box.x}, {"y", box.y}, {"width", box.width}, {"height", box.height}}), look,
          "", tooltip.empty() ? "" : "<title>" + EscapeXml(tooltip) + "</title>");
}

void SvgPicture::Line(double x1, double y1, double x2, double y2, std::string_view look) {
  Element("line", Numbers({{"x1", x1}, {"y1", y1}, {"x2", x2}, {"y2", y2}}), look);
}

void SvgPicture::Circle(double x, double y, double radius, std::string_view look) {
  Element("circle", Numbers({{"cx", x}, {"cy", y}, {"r", radius}}), look);
}

void SvgPicture::Lines(const std::vector<SvgLine>& lines, std::string_view look) {
  if (lines.empty()) return;
  PathData data;
  for (const SvgLine& line : lines) {
    data.MoveTo(line.x1, line.y1);
    data.LineTo(line.x2, line.y2);
  }
  Element("path", "", look, " d=\"" + data.text() + '"');
}

void SvgPicture::Polyline(const std::vector<std::pair<double, double>>& points,
                          std::string_view look) {
  if (points.size() < 2) return;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  Thin(points, 0, points.size() - 1, &kept);
  PathData data;
  data.MoveTo(points.front().first, points.front().second);
  for (size_t i = 1; i < points.size(); ++i) {
    if (kept[i]) data.LineTo(points[i].first, points[i].second);
  }
  Element("path", "", look, " d=\"" + data.text() + '"');
}

void SvgPicture::Text(double x, double y, std::string_view text, std::string_view look) {
  if (text.empty()) return;
  Element("text", Numbers({{"x", x}, {"y", y}}), look, "", WithMinusSigns(EscapeXml(text)));
}

void SvgPicture::TextUp(double x, double y, std::string_view text, std::string_view look) {
  if (text.empty()) return;
  Element("text", " transform=\"translate(" + SvgNumber(x) + ' ' + SvgNumber(y) + ")rotate(-90)\"",
          look, "", WithMinusSigns(EscapeXml(text)));
}

std::string SvgPicture::ToString() const {
  return Drawn("<style>" + std::string(SvgStyle()) + "</style>\n");
}

std::string SvgPicture::ToInline() const { return Drawn(""); }

std::string SvgPicture::Drawn(const std::string& style) const {
  const std::string width = SvgNumber(width_), height = SvgNumber(height_);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + ' ' + height + "\" role=\"img\">\n" + style + body_ +
         "</svg>\n";
}

SvgScale::SvgScale(double from, double to, double from_pixel, double to_pixel)
    : from_(from), to_(to > from ? to : from + 1.0), from_pixel_(from_pixel), to_pixel_(to_pixel) {}

double SvgScale::operator()(double value) const {
  return from_pixel_ + (value - from_) / (to_ - from_) * (to_pixel_ - from_pixel_);
}

std::vector<double> SvgScale::Ticks(int wanted) const {
  const double raw = (to_ - from_) / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;  // 1 .. 10
  const double step = power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
  std::vector<double> ticks;
  const double slack = 1e-9 * (to_ - from_);
  for (long k = std::lround(std::ceil((from_ - slack) / step)); k * step <= to_ + slack; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

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
