// ident: a page on which something moves in three dimensions: a canvas that turns, tilts and zooms,
// a slider, play, speed, arrow keys, and check boxes. What moves and how it is drawn is the
// caller's script; the page holds all of it and needs no network.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pushid {

struct MovingPage {
  std::string described;    // a description of the canvas for people who cannot see it
  std::string light, dark;  // CSS variables of the caller's colours: "--recorded:#777"
  std::string choices;      // check boxes; each change draws anew
  // An array of what can be chosen, each with `title`, `dt` (s) and `frames`.
  nlohmann::json data;
  // Sees `data` (the one that is chosen), `view`, `pen`, `$` (element by id) and `style` (value of
  // a CSS variable); declares `frame`, `turn`, `tilt` and `zoom` by let, open(), which prepares for
  // `data`, and draw(), which draws `frame` and sets the clock.
  std::string script;
  std::vector<std::string> figures = {};  // SVG without style sheets, below the motion
};

std::string ToHtml(const MovingPage& page);

}  // namespace pushid
