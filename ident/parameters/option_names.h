// ident: options of several names at once, for flags and JSON alike. Those of one name are read by
// ParseName (datasets/files/names.h).
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "models/options.h"

namespace pushid {

// Interaction terms: comma-separated pieces; "contact" and "ldp" are short for two of them each.
std::string NameOf(const InteractionTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms);

// Process noise: diagonal or full, and what it grows with: "diagonal,speed,push".
std::string NameOf(const ProcessNoiseTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, ProcessNoiseTerms* terms);

}  // namespace pushid
