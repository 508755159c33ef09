// ident: the table of option names.
#include "ident/option_names.h"

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
const OptionNames<Interaction>& Names(Interaction) {
  static const OptionNames<Interaction> names = {{"none", Interaction::kNone},
                                                 {"contact", Interaction::kContact}};
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

}  // namespace pushid
