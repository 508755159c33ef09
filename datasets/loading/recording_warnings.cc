// datasets: grouping warnings.
#include "datasets/loading/recording_warnings.h"

#include <algorithm>
#include <cctype>

namespace pushid {
namespace {

constexpr size_t kNamed = 3;  // recordings of a group that it names
constexpr char kRecording[] = "recording ";

struct Group {
  std::string key, first;        // what is the same; the first warning, whole
  std::vector<std::string> ids;  // empty: of no recording
  int count = 0;
};

// "a.bvh", "walks/a.c3d"
bool IsFileName(const std::string& word) {
  const size_t dot = word.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == word.size()) return false;
  return std::all_of(word.begin() + static_cast<long>(dot) + 1, word.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0; });
}

// "recording 'a b': a.bvh has" and "recording a: it has".
Group Read(const std::string& warning) {
  Group read{warning, warning, {}, 1};
  if (warning.rfind(kRecording, 0) != 0) return read;
  size_t begin = sizeof kRecording - 1;
  const bool quoted = warning[begin] == '\'';
  begin += quoted ? 1 : 0;
  const size_t end = warning.find(quoted ? '\'' : ':', begin);
  if (end == std::string::npos) return read;
  read.ids = {warning.substr(begin, end - begin)};
  read.key = warning.substr(end + (quoted ? 1 : 0));
  if (read.key.rfind(": ", 0) != 0) return read;
  const std::string word = read.key.substr(2, read.key.find(' ', 2) - 2);
  if (IsFileName(word)) read.key.replace(2, word.size(), "the file");
  return read;
}

std::string Text(const Group& group) {
  const std::string count = std::to_string(group.count);
  if (group.count == 1) return group.first;
  if (group.ids.size() < 2) return group.first + " (" + count + " times)";
  std::string names;
  for (size_t i = 0; i < std::min(kNamed, group.ids.size()); ++i) {
    names += (i > 0 ? ", " : "") + group.ids[i];
  }
  const std::string more = group.ids.size() > kNamed ? ", ..." : "";
  const std::string colon = group.key.rfind(':', 0) == 0 ? "" : ":";
  return "in " + std::to_string(group.ids.size()) + " recordings (" + names + more + ")" + colon +
         group.key;
}

}  // namespace

std::vector<std::string> GroupedWarnings(const std::vector<std::string>& warnings) {
  std::vector<Group> groups;
  for (const std::string& warning : warnings) {
    const Group read = Read(warning);
    const auto same = std::find_if(groups.begin(), groups.end(), [&read](const Group& group) {
      return group.key == read.key && group.ids.empty() == read.ids.empty();
    });
    if (same == groups.end()) {
      groups.push_back(read);
      continue;
    }
    ++same->count;
    // One recording may say it of several people.
    for (const std::string& id : read.ids) {
      const bool known = std::find(same->ids.begin(), same->ids.end(), id) != same->ids.end();
      if (!known) same->ids.push_back(id);
    }
  }
  std::vector<std::string> texts;
  for (const Group& group : groups) texts.push_back(Text(group));
  return texts;
}

}  // namespace pushid
