// Pages in a real browser (Debian's chromium, headless).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/run_app.h"

namespace pushid {

// Its path; empty where there is none.
inline std::string Browser() {
  const char* path = std::getenv("PATH");
  std::string folders = path == nullptr ? "" : path;
  for (size_t from = 0; from < folders.size();) {
    const size_t end = std::min(folders.find(':', from), folders.size());
    const std::string candidate = folders.substr(from, end - from) + "/chromium";
    std::error_code ignored;
    if (std::filesystem::exists(candidate, ignored)) return candidate;
    from = end + 1;
  }
  return "";
}

// The page with a script that drives it: `script` pushes what it sees to `said`, which stands in an
// element of its own at the end.
inline std::string Probed(std::string page, const std::string& script) {
  return page.replace(page.find("</body>"), 7,
                      "<script>addEventListener('load', () => { const said = [];\n" + script + R"js(
  const note = document.createElement('pre');
  note.id = 'probe';
  note.textContent = said.join('; ');
  document.body.append(note);
});
</script></body>)js");
}

// Pushes what is wrong with the page's layout: wider than its window; labels of a picture that are
// cut off by its frame, lie on each other or are small; headings that the links hide when one goes
// there.
inline constexpr char kLayoutProbe[] = R"js(
  const smallest = 9, touch = [1.5, 3.5];  // pixels; boxes of letters are higher than the letters
  const name = element => `${(element.closest('section') || document.body).id} '${element.textContent.trim()}'`;
  if (document.documentElement.scrollWidth > innerWidth) said.push('wider than the window');
  let labels = 0;
  for (const picture of document.querySelectorAll('svg')) {
    const frame = picture.getBoundingClientRect();
    if (!frame.width) continue;
    const texts = [...picture.querySelectorAll('text')].map(t => [t, t.getBoundingClientRect()]);
    labels += texts.length;
    texts.forEach(([text, a], i) => {
      const inside = a.left >= frame.left - 1 && a.right <= frame.right + 1 && a.top >= frame.top - 1 && a.bottom <= frame.bottom + 1;
      if (!inside) said.push('cut off: ' + name(text));
      if (a.height < smallest) said.push('small: ' + name(text));
      for (const [other, b] of texts.slice(i + 1)) {
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (wide > touch[0] && high > touch[1]) said.push(`overlap: ${name(text)} and ${name(other)}`);
      }
    });
  }
  for (const link of document.querySelectorAll('nav a')) {
    const section = document.querySelector(link.getAttribute('href'));
    section.scrollIntoView();
    const bar = document.querySelector('nav').getBoundingClientRect();
    const heading = section.querySelector('h2').getBoundingClientRect();
    if (heading.top < bar.bottom && heading.bottom > bar.top && heading.left < bar.right) said.push('hidden: ' + name(link));
  }
  said.push(`${labels} labels in ${innerWidth} pixels`);
)js";

// Widths that pages are looked at in: a desk's and a telephone's.
inline constexpr int kWidths[] = {1200, 400};

// Probed pages, each in a frame of every width, whose notes are copied out of them: windows are at
// least 500 pixels wide, and a browser takes a second to start.
inline std::string Framed(const std::vector<std::string>& pages) {
  std::string frames;
  for (const std::string& page : pages) {
    std::string quoted;
    for (const char c : page) {
      quoted += c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    }
    for (const int width : kWidths) {
      frames += "<iframe style=\"border:0;height:800px;width:" + std::to_string(width) +
                "px\" srcdoc=\"" + quoted + "\"></iframe>";
    }
  }
  return "<!DOCTYPE html><html><head><meta charset=\"utf-8\"></head><body>" + frames +
         R"js(<script>
onload = () => document.querySelectorAll('iframe').forEach(frame => document.body.append(
    frame.contentDocument.getElementById('probe').cloneNode(true)));
</script></body></html>)js";
}

// The page's elements after its scripts ran, on stdout; what the console said, on stderr. profile:
// a folder for the browser's own files.
inline AppRun Browse(const std::string& profile, const std::string& page) {
  return RunProgram(Browser(), {"--headless", "--no-sandbox", "--disable-gpu",
                                "--enable-logging=stderr", "--window-size=1000,800",
                                "--user-data-dir=" + profile, "--dump-dom", "file://" + page});
}

// What a probe said, the one of the frame with this number; a remark of its own where the page's
// script stopped early.
inline std::string WhatItSaid(const AppRun& seen, int frame = 0) {
  const std::string opens = "<pre id=\"probe\">";
  size_t begin = seen.out.find(opens);
  for (; frame > 0 && begin != std::string::npos; --frame) begin = seen.out.find(opens, begin + 1);
  if (begin == std::string::npos) return "the probe did not finish: " + seen.err;
  const size_t end = seen.out.find("</pre>", begin);
  return seen.out.substr(begin + opens.size(), end - begin - opens.size());
}

}  // namespace pushid
