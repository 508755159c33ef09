// datasets: looking through folders.
#include "datasets/files/found_files.h"

#include <algorithm>
#include <filesystem>

#include "datasets/files/number_text.h"

namespace pushid {

namespace fs = std::filesystem;

Result<std::vector<std::string>> FilesBelow(const std::string& folder) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) return Error{"there is no such folder", folder};
  std::vector<std::string> files;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied,
                                      failed);
  for (; !failed && it != fs::recursive_directory_iterator(); it.increment(failed)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored)) {
      files.push_back(it->path().lexically_relative(folder).generic_string());
    }
  }
  if (failed) return Error{"cannot look through it: " + failed.message(), folder};
  std::sort(files.begin(), files.end());
  return files;
}

bool PersonBefore(const FoundFile& a, const FoundFile& b) {
  std::int64_t x = 0, y = 0;
  const std::string &p = a.values.at("person"), &q = b.values.at("person");
  const bool numbers = ParseInteger(p, &x) && ParseInteger(q, &y);
  return numbers && x != y ? x < y : p < q;
}

std::string IdOf(const NamePattern& pattern, const NameValues& values) {
  const bool several = pattern.Has("person");
  std::string id;
  for (const std::string& name : pattern.names()) {
    if (name == "person" || (several && name == "subject")) continue;
    id += (id.empty() ? "" : "_") + values.at(name);
  }
  return id.empty() ? "recording" : id;
}

MaybeError CheckTogether(const std::string& id, const std::vector<FoundFile>& files, bool people,
                         const std::string& folder) {
  const auto rest = [](NameValues values) {
    values.erase("person");
    values.erase("subject");
    return values;
  };
  for (std::size_t i = 1; i < files.size(); ++i) {
    const FoundFile &a = files[i - 1], &b = files[i];
    const bool same = !people || a.values.at("person") == b.values.at("person");
    if (!same && rest(a.values) == rest(b.values)) continue;
    return Error{a.path + " and " + b.path + " are both " +
                     (people && same ? "person " + Quoted(a.values.at("person")) + " of " : "") +
                     "recording " + Quoted(id) +
                     (rest(a.values) == rest(b.values)
                          ? "; replace the * that differs by a name in the pattern"
                          : "; give one of them another name"),
                 folder};
  }
  return std::nullopt;
}

}  // namespace pushid
