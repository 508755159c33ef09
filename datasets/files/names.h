// datasets: names: lists of them in messages, choices by name, the closest name to a misspelt one,
// and naming patterns of files.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/number_text.h"
#include "models/enum_names.h"

namespace pushid {

// "a, b, c, ... (75 points)": the first names, and how many there are if not all are listed.
std::string ListOfNames(const std::vector<std::string>& names, std::size_t most = 60,
                        const std::string& plural = "");

// "a, b, c"
std::string Joined(const std::vector<std::string>& texts, const std::string& between = ", ");
// "1 score", "2 scores"; plural: where it is not the noun with an s.
std::string CountText(std::size_t number, const std::string& noun, const std::string& plural = "");

// Most names of a file that an error lists.
inline constexpr std::size_t kNamesInErrors = 8;

// "there is no joint 'Hip'; it has Hips, Spine, ... (75 joints); did you mean Hips?"
Error UnknownNameError(const std::string& path, const std::string& noun,
                       const std::vector<std::string>& names, const std::string& name);

// The known word of which `word` is most likely a misspelling; empty where `word` is known itself
// or like none of them.
std::string ClosestName(const std::string& word, const std::vector<std::string>& known);

// "; did you mean hip?", or nothing.
std::string Suggestion(const std::string& word, const std::vector<std::string>& known);

// "a,b" as a and b; none of an empty text.
std::vector<std::string> SplitList(const std::string& text, char separator = ',');

// The end of a name, and what stands in a text.

inline bool EndsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

inline bool Holds(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

// A choice by its name (models/enum_names.h). Error: "--posture is 'flat'; it must be upright or
// initial".
template <typename E>
MaybeError ParseName(const std::string& flag, std::string_view text, E* value) {
  const std::optional<E> found = FromName<E>(text);
  if (!found) return Error{flag + " is " + Quoted(text) + "; it must be " + AnyName<E>()};
  *value = *found;
  return std::nullopt;
}

using NameValues = std::map<std::string, std::string>;

// A naming pattern of recordings: "{setting}/{subject}_{magnitude}_{take}.c3d".
//
// A name in braces stands for one or more characters other than /, as few as make the whole fit;
// the same name twice means the same text. * stands for any characters other than /, that do not
// matter. Everything else stands for itself.
class NamePattern {
 public:
  // Errors: a brace that is not closed or closes nothing, an empty name, no name at all.
  static Result<NamePattern> Parse(const std::string& text);

  const std::vector<std::string>& names() const { return names_; }  // each once, in order
  bool Has(const std::string& name) const;
  bool HasStar() const;

  // The values of all names where `path` fits entirely.
  std::optional<NameValues> Match(const std::string& path) const;

  // The pattern with its names replaced; nullopt where a value is missing or the pattern has a *.
  std::optional<std::string> Fill(const NameValues& values) const;

 private:
  struct Piece {
    enum Kind { kText, kName, kAnything } kind;
    std::string text;  // or the name
  };
  bool MatchFrom(std::size_t piece, const std::string& path, std::size_t at, NameValues* values,
                 int* tries) const;

  std::vector<Piece> pieces_;
  std::vector<std::string> names_;
};

// Every regular file below the folder, as sorted paths relative to it.
Result<std::vector<std::string>> FilesBelow(const std::string& folder);

}  // namespace pushid
