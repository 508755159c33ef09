// ident: the table of option names.
#include "ident/parameters/option_names.h"

#include <algorithm>
#include <sstream>

namespace pushid {

const OptionNames<Posture>& Names(Posture) {
  static const OptionNames<Posture> names = {{"upright", Posture::kUpright},
                                             {"initial", Posture::kInitial}};
  return names;
}
const OptionNames<GainScaling>& Names(GainScaling) {
  static const OptionNames<GainScaling> names = {
      {"none", GainScaling::kNone}, {"mass", GainScaling::kMass}, {"body", GainScaling::kBody}};
  return names;
}
const OptionNames<FrictionKind>& Names(FrictionKind) {
  static const OptionNames<FrictionKind> names = {{"isotropic", FrictionKind::kIsotropic},
                                                  {"anisotropic", FrictionKind::kAnisotropic}};
  return names;
}
const OptionNames<PushUse>& Names(PushUse) {
  static const OptionNames<PushUse> names = {{"as_recorded", PushUse::kAsRecorded},
                                             {"added", PushUse::kAdded}};
  return names;
}
const OptionNames<PushTail>& Names(PushTail) {
  static const OptionNames<PushTail> names = {{"none", PushTail::kNone},
                                              {"exponential", PushTail::kExponential}};
  return names;
}
const OptionNames<CartDerivative>& Names(CartDerivative) {
  static const OptionNames<CartDerivative> names = {{"none", CartDerivative::kNone},
                                                    {"backward", CartDerivative::kBackward}};
  return names;
}
const OptionNames<SkeletonMapping>& Names(SkeletonMapping) {
  static const OptionNames<SkeletonMapping> names = {{"exact", SkeletonMapping::kExact},
                                                     {"ldp", SkeletonMapping::kLdp}};
  return names;
}
const OptionNames<SelfForceKind>& Names(SelfForceKind) {
  static const OptionNames<SelfForceKind> names = {{"none", SelfForceKind::kNone},
                                                   {"linear", SelfForceKind::kLinear}};
  return names;
}
const OptionNames<RecordingWeight>& Names(RecordingWeight) {
  static const OptionNames<RecordingWeight> names = {{"frame", RecordingWeight::kFrame},
                                                     {"recording", RecordingWeight::kRecording}};
  return names;
}
const OptionNames<FitStart>& Names(FitStart) {
  static const OptionNames<FitStart> names = {{"nominal", FitStart::kNominal},
                                              {"equation_error", FitStart::kEquationError}};
  return names;
}
const OptionNames<PoolBy>& Names(PoolBy) {
  static const OptionNames<PoolBy> names = {{"subject", PoolBy::kSubject},
                                            {"setting", PoolBy::kSetting}};
  return names;
}
const OptionNames<FoldScheme>& Names(FoldScheme) {
  static const OptionNames<FoldScheme> names = {{"stratified", FoldScheme::kStratified},
                                                {"subject", FoldScheme::kSubject},
                                                {"strong", FoldScheme::kStrong},
                                                {"setting", FoldScheme::kSetting}};
  return names;
}
const OptionNames<Transform>& Names(Transform) {
  static const OptionNames<Transform> names = {
      {"identity", Transform::kIdentity}, {"log", Transform::kLog}, {"logit", Transform::kLogit}};
  return names;
}
const OptionNames<EstimateStatus>& Names(EstimateStatus) {
  static const OptionNames<EstimateStatus> names = {
      {"identified", EstimateStatus::kIdentified},
      {"weak", EstimateStatus::kWeak},
      {"unidentifiable", EstimateStatus::kUnidentifiable},
      {"at bound", EstimateStatus::kAtBound},
      {"fixed", EstimateStatus::kFixed}};
  return names;
}
const OptionNames<ProfileClass>& Names(ProfileClass) {
  static const OptionNames<ProfileClass> names = {
      {"identifiable", ProfileClass::kIdentifiable},
      {"practically_not", ProfileClass::kPracticallyNot},
      {"structurally_not", ProfileClass::kStructurallyNot}};
  return names;
}

namespace {

// Empty for an unknown name.
std::vector<bool InteractionTerms::*> TermsOf(const std::string& name) {
  if (name == "contact") return {&InteractionTerms::spring, &InteractionTerms::damping};
  if (name == "ldp") return {&InteractionTerms::potential, &InteractionTerms::lean};
  for (const auto& [known, member] : kInteractionTerms) {
    if (name == known) return {member};
  }
  return {};
}

}  // namespace

std::string NameOf(const InteractionTerms& terms) {
  std::string text;
  for (const auto& [name, member] : kInteractionTerms) {
    if (terms.*member) text += (text.empty() ? "" : ",") + std::string(name);
  }
  return text.empty() ? "none" : text;
}

MaybeError ParseName(const std::string& flag, const std::string& text, InteractionTerms* terms) {
  *terms = {};
  if (text == "none") return std::nullopt;
  std::stringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    const std::vector<bool InteractionTerms::*> members = TermsOf(part);
    if (part == "none") return Error{flag + ": none stands alone; leave it or the others out"};
    if (members.empty()) {
      std::string known = "contact (spring,damping), ldp (potential,lean)";
      for (const auto& term : kInteractionTerms) known += ", " + std::string(term.name);
      return Error{flag + " names '" + part + "'; it must be none, or some of " + known};
    }
    for (bool InteractionTerms::*member : members) {
      if (terms->*member) {
        return Error{flag + " names '" + part +
                     "' twice (contact is spring,damping; ldp is potential,lean)"};
      }
      terms->*member = true;
    }
  }
  if (terms->drive && !terms->Any()) {
    return Error{flag + ": drive acts on what people receive from others; add contact or ldp"};
  }
  return std::nullopt;
}

}  // namespace pushid
