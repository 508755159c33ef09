// datasets: warnings of many recordings, said once.
#include "datasets/files/error.h"

#include <algorithm>
#include <map>

#include "datasets/files/names.h"

namespace pushid {

std::vector<std::string> GroupedWarnings(const Warnings& warnings) {
  constexpr size_t kNamed = 3;  // recordings of a group that it names
  struct Group {
    Warning first;
    int count = 0;
    std::vector<std::string> ids;  // each once: one recording may say it of several people
  };
  std::vector<Group> groups;
  std::map<std::pair<bool, std::string>, size_t> places;
  for (const Warning& warning : warnings) {
    const std::string& id = warning.recording;
    const auto [place, is_new] = places.emplace(
        std::pair(id.empty(), id.empty() ? warning.text : warning.of_many), groups.size());
    if (is_new) groups.push_back({warning, 0, {}});
    Group& group = groups[place->second];
    ++group.count;
    if (std::find(group.ids.begin(), group.ids.end(), id) == group.ids.end()) {
      group.ids.push_back(id);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [first, count, ids] : groups) {
    if (ids.size() > 1) {
      const size_t named = std::min(kNamed, ids.size());
      texts.push_back(StrCat("in ", ids.size(), " recordings (",
                             Joined({ids.begin(), ids.begin() + named}),
                             ids.size() > named ? ", ..." : "", "): ", first.of_many));
    } else {
      texts.push_back(first.text + (count > 1 ? StrCat(" (", count, " times)") : ""));
    }
  }
  return texts;
}

}  // namespace pushid
