// ident: pictures as SVG text: a few shapes and labels, nothing that needs a library.
//
//   SvgPicture svg(640, 200, "hip speed");
//   svg.Rect({10, 10, 20, 8}, "fill:#440154");
//   svg.Text(10, 190, "time (s)", "axis middle");
//   WriteFileAtomically(path, svg.ToString());
//
// Lengths are pixels, y grows downwards. The classes paper, ink, axis, grid and faint follow the
// reader's light or dark setting; colours of data are given in full. Texts are escaped.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pushid {

// Escapes `&`, `<`, `>` and quotes for text and attributes; control characters become spaces.
std::string EscapeXml(std::string_view text);

// The shortest text with two decimals, enough for a pixel.
std::string SvgNumber(double value);

// The style sheet that every picture carries, for a page that holds many.
std::string_view SvgStyle();

struct SvgBox {
  double x, y, width, height;
};

struct SvgLine {
  double x1, y1, x2, y2;
};

class SvgPicture {
 public:
  // title: read by screen readers and shown by a browser's tab.
  SvgPicture(double width, double height, std::string_view title);

  // `look`: a CSS declaration ("fill:#fff;opacity:0.5") where it has a colon, else class names.
  void Rect(const SvgBox& box, std::string_view look, std::string_view tooltip = "");
  void Line(double x1, double y1, double x2, double y2, std::string_view look);
  // Draws many lines of one look as one element: a page of panels is mostly grid.
  void Lines(const std::vector<SvgLine>& lines, std::string_view look);
  void Circle(double x, double y, double radius, std::string_view look);
  // Fewer than two points draw nothing; points within 0.4 pixels of the line are left
  // out.
  void Polyline(const std::vector<std::pair<double, double>>& points, std::string_view look);
  // Classes middle and end set the anchor, small and bold the font. A number's hyphen becomes a
  // minus sign; an empty text draws nothing.
  void Text(double x, double y, std::string_view text, std::string_view look = "ink");
  // Text from (x, y) upwards.
  void TextUp(double x, double y, std::string_view text, std::string_view look = "ink");

  std::string ToString() const;
  // The picture for a page that has SvgStyle: without a style sheet of its own.
  std::string ToInline() const;

 private:
  std::string Drawn(const std::string& style) const;
  // Attributes before and after the look, and what is in the element.
  void Element(const std::string& name, const std::string& before, std::string_view look,
               const std::string& after = "", const std::string& content = "");

  double width_, height_;
  std::string body_;
};

// A linear axis from data to pixels, with round ticks.
class SvgScale {
 public:
  // from_pixel may exceed to_pixel: the vertical axis of a plot.
  SvgScale(double from, double to, double from_pixel, double to_pixel);
  double operator()(double value) const;
  double from() const { return from_; }
  double to() const { return to_; }
  // Ticks at multiples of 1, 2 or 5 times a power of ten within the range, about `wanted` of them.
  std::vector<double> Ticks(int wanted) const;

 private:
  double from_, to_, from_pixel_, to_pixel_;
};

// "#rrggbb" of a fraction in [0, 1] (clamped): dark blue, green, yellow, of even steps in lightness
// (viridis), so that it reads in grey and by the colour-blind.
std::string ColourOf(double fraction);

// Colour of a fraction in [-1, 1]: from orange over near white at zero to blue.
std::string SignedColourOf(double fraction);

}  // namespace pushid
