// datasets: files that a naming pattern finds in a folder, and which of them make one recording.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/name_pattern.h"

namespace pushid {

using NameValues = std::map<std::string, std::string>;

struct FoundFile {
  std::string path;  // relative to the folder
  NameValues values;
};

// Every regular file below the folder, as sorted paths relative to it.
Result<std::vector<std::string>> FilesBelow(const std::string& folder);

// Of the recording that a file belongs to: its values but those of the person.
std::string IdOf(const NamePattern& pattern, const NameValues& values);

// "7" before "10", and both before "a".
bool PersonBefore(const FoundFile& a, const FoundFile& b);

// Files of one recording differ in their person, and besides in the subject alone.
// people: whether the pattern names persons; otherwise a recording is one file.
MaybeError CheckTogether(const std::string& id, const std::vector<FoundFile>& files, bool people,
                         const std::string& folder);

}  // namespace pushid
