// ident: checks of recordings before a prediction.
#include "ident/prediction/input_warnings.h"

#include <algorithm>

#include "ident/diagnostics/diagnostics.h"
#include "ident/results/push_range.h"

namespace pushid {

std::vector<std::string> InputWarnings(const IdentifiedModel& model,
                                       const std::vector<PendulumRecording>& recordings) {
  std::vector<std::string> warnings = UnitWarnings(recordings);
  const bool together =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const PendulumRecording& r) { return r.scene.num_people() > 1; });
  if (together && !model.options.interaction.Any()) {
    warnings.push_back(
        (model.source.empty() ? "the model" : model.source) +
        " was fitted without interaction: people will not affect each other; fit recordings of "
        "groups with an interaction (pushid-fit --setting=groups --interaction=contact)");
  }
  for (const std::string& warning : ExtrapolationWarnings(model, recordings)) {
    warnings.push_back(warning);
  }
  return warnings;
}

}  // namespace pushid
