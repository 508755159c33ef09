// ident: presets with published values.
#include "ident/validation/synthetic_truth.h"

#include "datasets/files/names.h"
#include "ident/fit/fit_setup.h"

namespace pushid {

Result<IdentifiedModel> SyntheticTruth(const SyntheticOptions& study, const std::string& set) {
  const Stance stance = study.model.stance;
  const bool groups = study.people_in_row > 1, slide = stance == Stance::kSlide;
  const Result<FitOptions> made = MakeFitOptions({{"preset", groups ? "group" : "tail"},
                                                  {"stance", NameOf(study.model.stance)},
                                                  {"delay", NameOf(study.model.delay)}});
  if (!made.ok()) return made.error();
  const FitOptions& preset = made.value();
  const ParameterSet<double> published =
      !slide ? PublishedStanceParameters()
             : (groups ? PublishedGroupParameters() : PublishedTailParameters());
  IdentifiedModel model;
  model.options = preset.model;
  model.options.process_noise = study.model.process_noise;  // which no fit by rollouts has
  model.table = preset.table;
  model.parameters = preset.table.Values();
  for (Parameter id : preset.table.Free()) {
    // People who stand, and delays, are as the preset has them.
    const bool of_delay = id >= kReactionDelay && id <= kPassiveDamping;
    if (stance == Stance::kFixed || of_delay) continue;
    if (!IsPairParameter(id) || slide) model.parameters[id] = published[id];
  }
  model.table.SetTied(&model.parameters);
  if (MaybeError error = SetValues(set, &model)) return *error;
  return model;
}

}  // namespace pushid
