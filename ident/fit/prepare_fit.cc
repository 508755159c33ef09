// ident: options made fit for recordings.
#include <algorithm>
#include <set>

#include "datasets/files/number_text.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/diagnostics/diagnostics.h"
#include "ident/fit/covariates.h"
#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/parameters/presets.h"
#include "ident/parameters/pushed_feet.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

bool AnyGroup(const std::vector<PendulumRecording>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [](const PendulumRecording& recording) { return recording.num_people() > 1; });
}

Warnings WarningsBefore(const std::vector<PendulumRecording>& recordings,
                        const FitOptions& options) {
  Warnings warnings = FindingWarnings(FitFindings(FindingsOf(recordings)));
  if (AnyGroup(recordings) && !options.model.interaction.Any()) {
    warnings.emplace_back(
        "recordings contain several people, but the model has no interaction between them "
        "(--preset=group or --interaction=contact adds one)");
  }
  if (options.model.body != BodyModel::kAnthropometric) return warnings;
  for (const PendulumRecording& recording : recordings) {
    if (std::none_of(recording.masses.begin(), recording.masses.end(), IsAverage)) continue;
    const std::string what =
        "neither segments nor shoulders were read, so that --body=anthropometric takes the body of "
        "an average person; name them in the manifest (\"joints\"), or enter com_height with "
        "--body=ldp";
    warnings.emplace_back("recording " + recording.id + ": " + what, recording.id, what);
  }
  return warnings;
}

// Where all share one unit, its deviation and the shared value would be one number. It is
// a warning only where pooling was asked for.
void UnpoolOneUnit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                   Warnings* warnings) {
  if (!AnyPooled(options->table)) return;
  std::set<std::string> units;
  for (const PendulumRecording& recording : recordings) {
    for (const std::string& unit : PoolingUnits(recording, options->pool_by)) units.insert(unit);
  }
  if (units.size() > 1) return;
  for (ParameterSpec& spec : options->table.specs) spec.pooled = false;
  Result<FitOptions> preset = StartPreset(options->preset);
  if (!preset.ok()) return;
  SetStance(options->model.stance, &preset.value());  // which pools by itself
  const bool asked =
      preset.value().pool != options->pool || preset.value().pool_by != options->pool_by;
  if (!asked) return;
  const bool named = preset.value().pool != options->pool;
  warnings->push_back((named ? "--pool=" + options->pool : "--pool_by=" + options->pool_by) +
                      " does nothing: all recordings share one " + options->pool_by + ", '" +
                      *units.begin() + "'");
}

// A label that no recording has pools by nothing; that of the presets may be absent.
MaybeError CheckPoolingLabel(const std::vector<PendulumRecording>& recordings,
                             const FitOptions& options) {
  const std::string& key = options.pool_by;
  if (key == kSubjectUnit || key == kSettingLabel || key == kConditionLabel) return std::nullopt;
  return CheckLabel(recordings, "pool_by", key, kSubjectUnit);
}

MaybeError CheckFrameRates(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options) {
  if (options.model.stance != Stance::kSteps) return std::nullopt;
  for (const PendulumRecording& recording : recordings) {
    const double rate = 1.0 / recording.scene.dt;
    if (rate >= kLeastSteppingRate) continue;
    return Error{"recording " + recording.id + " has " + Rounded(rate, 3) +
                 " frames per second, too few for --stance=steps; resample it "
                 "(--resample_fps=60), or let feet slide"};
  }
  return std::nullopt;
}

// A likelihood of single steps knows the state [q, qd] of everybody and nothing else.
MaybeError CheckLikelihood(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options) {
  const ModelOptions& model = options.model;
  if (options.likelihood == Likelihood::kTrajectory) return std::nullopt;
  if (const std::string what = MemoryOf(model); !what.empty()) {
    return Error{
        "the likelihoods of single steps require a model whose state is position and velocity; " +
        what +
        (model.learned != nullptr ? " has weights, which they cannot fit"
                                  : " has internal memory") +
        ": leave one of them out"};
  }
  for (const PendulumRecording& r : recordings) {
    if (r.num_frames() < 3) {
      return Error{"recording " + r.id + " has too few frames for a likelihood of single steps"};
    }
    if (r.initial_velocity != InitialVelocity::kFree) continue;
    return Error{"recording " + r.id +
                 " has free initial velocities, which likelihoods of single steps cannot fit; "
                 "set initial_velocity to zero or estimated in the manifest"};
  }
  return std::nullopt;
}

}  // namespace

MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      Warnings* warnings) {
  if (recordings.empty()) return Error{"there are no recordings to fit"};
  if (options->model.interaction.learned && !AnyGroup(recordings)) {
    return Error{
        "--interaction names a network between people, but every recording is of one person; leave "
        "it out, or fit recordings of groups"};
  }
  if (MaybeError error = CheckPoolingLabel(recordings, *options)) return error;
  if (MaybeError error = CheckFrameRates(recordings, *options)) return error;
  if (MaybeError error = CheckLaboratory(recordings, *options)) return error;
  if (MaybeError error = CheckLikelihood(recordings, *options)) return error;
  Warnings told;
  UnpoolOneUnit(recordings, options, &told);
  std::string invalid;
  if (!options->IsValid(&invalid)) return Error{invalid};
  HoldUnusedTail(recordings, options);
  if (MaybeError error = AddCovariates(recordings, options, &told)) return error;
  if (options->table.Free().empty()) {
    return Error{"every parameter that acts on these recordings is fixed: nothing is left to fit"};
  }
  if (warnings != nullptr) {
    *warnings = WarningsBefore(recordings, *options);
    warnings->insert(warnings->end(), told.begin(), told.end());
  }
  // A large network has no force yet and no Jacobian at all: the physical model is what is checked.
  const FitOptions checked = NeedsGradientTraining(*options) ? PhysicsAlone(*options) : *options;
  return CheckEffects(FitProblem(recordings, checked));
}

}  // namespace pushid
