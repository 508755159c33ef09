// datasets: warnings of many recordings, said once.
#include "datasets/files/error.h"

#include <algorithm>

namespace pushid {
namespace {

constexpr size_t kNamed = 3;  // recordings of a group that it names

struct Group {
  Warning first;
  std::vector<std::string> ids;  // empty: of no recording
  int count = 0;

  bool Holds(const Warning& warning) const {
    if (ids.empty() || warning.recording.empty()) {
      return ids.empty() && warning.recording.empty() && first.text == warning.text;
    }
    return first.of_many == warning.of_many;
  }
  void Add(const Warning& warning) {
    ++count;
    // One recording may say it of several people.
    const std::string& id = warning.recording;
    if (!id.empty() && std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }
  std::string Text() const {
    if (count == 1) return first.text;
    if (ids.size() < 2) return first.text + " (" + std::to_string(count) + " times)";
    std::string names;
    for (size_t i = 0; i < std::min(kNamed, ids.size()); ++i) {
      names += (i > 0 ? ", " : "") + ids[i];
    }
    return "in " + std::to_string(ids.size()) + " recordings (" + names +
           (ids.size() > kNamed ? ", ..." : "") + "): " + first.of_many;
  }
};

}  // namespace

std::vector<std::string> GroupedWarnings(const Warnings& warnings) {
  std::vector<Group> groups;
  for (const Warning& warning : warnings) {
    auto same = std::find_if(groups.begin(), groups.end(),
                             [&warning](const Group& group) { return group.Holds(warning); });
    if (same == groups.end()) same = groups.insert(same, Group{warning, {}, 0});
    same->Add(warning);
  }
  std::vector<std::string> texts;
  for (const Group& group : groups) texts.push_back(group.Text());
  return texts;
}

}  // namespace pushid
