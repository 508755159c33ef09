// datasets: naming patterns of recordings: "{setting}/{subject}_{magnitude}_{take}.c3d".
//
// A name in braces stands for one or more characters other than /, as few as make the whole fit;
// the same name twice means the same text. * stands for any characters other than /, that do not
// matter. Everything else stands for itself.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

class NamePattern {
 public:
  // Errors: a brace that is not closed or closes nothing, an empty name, no name at all.
  static Result<NamePattern> Parse(const std::string& text);

  const std::vector<std::string>& names() const { return names_; }  // each once, in order
  bool Has(const std::string& name) const;
  bool HasStar() const;

  // The values of all names where `path` fits entirely.
  std::optional<std::map<std::string, std::string>> Match(const std::string& path) const;

  // The pattern with its names replaced; nullopt where a value is missing or the pattern has a *.
  std::optional<std::string> Fill(const std::map<std::string, std::string>& values) const;

 private:
  struct Piece {
    enum Kind { kText, kName, kAnything } kind;
    std::string text;  // or the name
  };
  bool MatchFrom(std::size_t piece, const std::string& path, std::size_t at,
                 std::map<std::string, std::string>* values, int* tries) const;

  std::vector<Piece> pieces_;
  std::vector<std::string> names_;
};

// Files that a naming pattern finds in a folder, and which of them make one recording.

using NameValues = std::map<std::string, std::string>;

struct FoundFile {
  std::string path;  // relative to the folder
  NameValues values;
};

// Every regular file below the folder, as sorted paths relative to it.
Result<std::vector<std::string>> FilesBelow(const std::string& folder);

// The id of the recording that a file belongs to: its values without the person's.
std::string IdOf(const NamePattern& pattern, const NameValues& values);

// "7" before "10", and both before "a".
bool PersonBefore(const FoundFile& a, const FoundFile& b);

// Files of one recording differ in their person, and besides in the subject alone.
// people: whether the pattern names persons; otherwise a recording is one file.
MaybeError CheckTogether(const std::string& id, const std::vector<FoundFile>& files, bool people,
                         const std::string& folder);

}  // namespace pushid
