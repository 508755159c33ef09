// ident: names of the options, one table for flags and JSON alike.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "ident/parameters/fit_options.h"
#include "ident/uncertainty/profile.h"
#include "ident/uncertainty/uncertainty.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {

template <typename E>
using OptionNames = std::vector<std::pair<std::string, E>>;

const OptionNames<Posture>& Names(Posture);
const OptionNames<GainScaling>& Names(GainScaling);
const OptionNames<FrictionKind>& Names(FrictionKind);
const OptionNames<PushUse>& Names(PushUse);
const OptionNames<PushTail>& Names(PushTail);
const OptionNames<CartDerivative>& Names(CartDerivative);
const OptionNames<SkeletonMapping>& Names(SkeletonMapping);
const OptionNames<SelfForceKind>& Names(SelfForceKind);
const OptionNames<RecordingWeight>& Names(RecordingWeight);
const OptionNames<FitStart>& Names(FitStart);
const OptionNames<PoolBy>& Names(PoolBy);
const OptionNames<FoldScheme>& Names(FoldScheme);
const OptionNames<Transform>& Names(Transform);
const OptionNames<EstimateStatus>& Names(EstimateStatus);
const OptionNames<ProfileClass>& Names(ProfileClass);

template <typename E>
std::string NameOf(E value) {
  for (const auto& [name, option] : Names(E{})) {
    if (option == value) return name;
  }
  return "";
}

// Errors: "--posture is 'flat'; it must be upright or initial".
template <typename E>
MaybeError ParseName(const std::string& flag, const std::string& text, E* value) {
  std::string known;
  for (const auto& [name, option] : Names(E{})) {
    if (name == text) {
      *value = option;
      return std::nullopt;
    }
    known += (known.empty() ? "" : ", ") + name;
  }
  return Error{flag + " is '" + text + "'; it must be one of " + known};
}

// Interaction terms: comma-separated pieces; "contact" and "ldp" are short for two of them each.
std::string NameOf(const InteractionTerms& terms);
MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms);

}  // namespace pushid
