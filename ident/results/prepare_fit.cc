// ident: options made fit for recordings.
#include <algorithm>

#include "ident/diagnostics/diagnostics.h"
#include "ident/problem/fit_problem.h"
#include "ident/results/fit.h"
#include "ident/solver/large_network_stage.h"

namespace pushid {
namespace {

std::vector<std::string> WarningsBefore(const std::vector<PendulumRecording>& recordings,
                                        const FitOptions& options) {
  std::vector<std::string> warnings = UnitWarnings(recordings);
  const bool groups =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const PendulumRecording& recording) { return recording.num_people() > 1; });
  if (groups && !options.model.interaction.Any()) {
    warnings.push_back(
        "several people stand in one recording, and the model has nothing between them "
        "(--preset=group and --interaction=contact have)");
  }
  return warnings;
}

}  // namespace

MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      std::vector<std::string>* warnings) {
  if (recordings.empty()) return Error{"there are no recordings to fit"};
  std::string invalid;
  if (!options->IsValid(&invalid)) return Error{invalid};
  HoldUnusedTail(recordings, options);
  if (options->table.Free().empty()) {
    return Error{"every parameter that acts on these recordings is fixed: nothing is left to fit"};
  }
  if (warnings != nullptr) *warnings = WarningsBefore(recordings, *options);
  // A large network has no force yet and no Jacobian at all: the physical model is what is checked.
  const FitOptions checked = NeedsGradientTraining(*options) ? PhysicsAlone(*options) : *options;
  return CheckEffects(FitProblem(recordings, checked));
}

}  // namespace pushid
