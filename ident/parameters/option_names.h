// ident: options by name, for flags and JSON alike. The names stand beside the enums
// (models/enum_names.h).
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/enum_names.h"
#include "models/options.h"

namespace pushid {

// The words for an enum's values.
template <typename E>
std::vector<std::string> AllNames() {
  std::vector<std::string> words;
  for (const EnumName<E>& row : Names(E{})) words.push_back(row.name);
  return words;
}

// Errors: "--posture is 'flat'; it must be upright or initial".
template <typename E>
MaybeError ParseName(const std::string& flag, const std::string& text, E* value) {
  std::string known;
  for (const EnumName<E>& row : Names(E{})) {
    if (text == row.name) {
      *value = row.value;
      return std::nullopt;
    }
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  return Error{flag + " is '" + text + "'; it must be one of " + known};
}

// Interaction terms: comma-separated pieces; "contact" and "ldp" are short for two of them each.
std::string NameOf(const InteractionTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms);

// Process noise: diagonal or full, and what it grows with: "diagonal,speed,push".
std::string NameOf(const ProcessNoiseTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, ProcessNoiseTerms* terms);

}  // namespace pushid
