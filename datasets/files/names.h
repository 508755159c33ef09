// datasets: names: lists of them in messages, choices by name, and the closest name to a misspelt
// one.
#pragma once

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

}  // namespace pushid
