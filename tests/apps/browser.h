// Pages in a real browser (Debian's chromium, headless).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

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
                      "<script>(function () { const said = [];\n" + script + R"js(
  const note = document.createElement('pre');
  note.id = 'probe';
  note.textContent = said.join('; ');
  document.body.append(note);
})();
</script></body>)js");
}

// The page's elements after its scripts ran, on stdout; what the console said, on stderr. profile:
// a folder for the browser's own files.
inline AppRun Browse(const std::string& profile, const std::string& page) {
  return RunProgram(Browser(), {"--headless", "--no-sandbox", "--disable-gpu",
                                "--enable-logging=stderr", "--window-size=1000,800",
                                "--user-data-dir=" + profile, "--dump-dom", "file://" + page});
}

}  // namespace pushid
