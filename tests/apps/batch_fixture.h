// A fixture: plans for pushid-batch over the small synthetic recordings, and the tables they end
// in.
#pragma once

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {

inline std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class BatchFixture : public AppTest {
 protected:
  // jobs: lines of [jobs]; variants: name and flags.
  std::string Plan(const std::string& jobs,
                   const std::vector<std::pair<std::string, std::string>>& variants,
                   const std::string& dir = "out", const std::string& name = "plan.toml") const {
    std::string text = "[data]\nrecordings = \"manifest.json\"\n[jobs]\n" + jobs + "\n";
    for (const auto& [variant, flags] : variants) {
      text += "[[variant]]\nname = \"" + variant + "\"\nflags = [" + flags + "]\n";
    }
    return "--plan=" + WriteText(name, text + "[output]\ndir = \"" + dir + "\"\n");
  }

  AppRun Batch(const std::string& plan, const std::vector<std::string>& more = {}) const {
    return RunApp("pushid-batch", With({plan, "--quiet"}, more));
  }

  // Ids of the jobs in the output of --list.
  static std::set<std::string> Ids(const std::string& listing) {
    std::set<std::string> ids;
    for (const std::string& line : Lines(listing)) ids.insert(line.substr(0, line.find(',')));
    ids.erase("id");
    return ids;
  }

  // summary.csv without what changes from run to run: the last two columns.
  std::vector<std::string> Table(const std::string& dir) const {
    std::vector<std::string> rows;
    for (std::string row : Lines(ReadText(Path(dir + "/summary.csv")))) {
      for (int i = 0; i < 2; ++i) row.erase(row.rfind(','));
      rows.push_back(row);
    }
    return rows;
  }
};

}  // namespace pushid
