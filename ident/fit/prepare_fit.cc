// ident: options made fit for recordings.
#include "ident/fit/prepare_fit.h"

#include <algorithm>
#include <set>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/diagnostics/diagnostics.h"
#include "ident/fit/covariates.h"
#include "ident/parameters/presets.h"
#include "ident/parameters/pushed_feet.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

// What to choose by where two options exclude each other.
constexpr char kQuestions[] =
    "rollouts (--likelihood=trajectory, with --delay and platforms) answer how stiff, damped and "
    "late people balance, likelihoods of single steps how much of their motion is noise";

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
        "an average person; name them in the manifest (\"joints\"), state com_over_rod and "
        "gyration_over_rod of the subject, or enter com_height with --body=ldp";
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
        ": leave one of them out; " + kQuestions};
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

namespace {

// A delay is seen in how an answer follows a push: a recording should last some times as long.
constexpr double kDelaysInRecording = 2.0;

MaybeError CheckDelay(const std::vector<PendulumRecording>& recordings, const FitOptions& options) {
  if (options.model.delay == Delay::kNone) return std::nullopt;
  if (options.model.cart_derivative != CartDerivative::kNone) {
    return Error{
        "--delay and the derivative of the cart's velocity (--preset=ldp_published) do not go "
        "together: a late difference of velocities has no meaning in short steps"};
  }
  for (Parameter id : {kReactionDelay, kStepDelay}) {
    if (!Acts(id, options.model)) continue;
    const ParameterSpec& spec = options.table[id];
    for (const PendulumRecording& r : recordings) {
      const double seconds = (r.num_frames() - 1) * r.scene.dt;
      if (seconds >= kDelaysInRecording * spec.nominal) continue;
      return Error{"recording " + r.id + " lasts " + Rounded(seconds, 3) + " s, too short for a " +
                   spec.name + " of " + Rounded(spec.nominal, 3) +
                   " s: nothing in it comes after the delay; leave the recording out, set a "
                   "shorter delay (--free=" +
                   spec.name + "=0.1), or fit with --delay=none"};
    }
  }
  return std::nullopt;
}

MaybeError CheckBodyModel(const FitOptions& options) {
  const ModelOptions& model = options.model;
  if (model.body != BodyModel::kTable) return std::nullopt;
  if (model.stance != Stance::kSlide) {
    return Error{"--body=table is for a pendulum on a cart that moves, but --stance is " +
                 NameOf(model.stance) +
                 "; add --stance=slide, or take the masses from the segments "
                 "(--body=anthropometric)"};
  }
  const ParameterSpec& gyration = options.table[kGyrationRadius];
  if (gyration.free && gyration.nominal == 0.0) {
    return Error{
        "gyration_radius is free and starts at 0, where nothing depends on it at first order; give "
        "a start, as in --free=gyration_radius=0.3"};
  }
  if (RodMoves(model)) return Error{"--body=table and --rod do not go together; leave one out"};
  return std::nullopt;
}

MaybeError CheckGround(const PendulumRecording& r, const ModelOptions& model) {
  const GroundMotion& ground = r.scene.ground;
  if (!ground.moves()) return std::nullopt;
  if (RodMoves(model)) {
    return Error{"recording " + r.id +
                 " is on moving ground, whose inertia no law of --rod has; leave --rod out, or the "
                 "recording"};
  }
  const bool tilts = std::any_of(ground.poses.begin(), ground.poses.end(),
                                 [](const GroundPose& pose) { return !pose.tail<2>().isZero(); });
  if (tilts && model.interaction.Any() && r.num_people() > 1) {
    return Error{"recording " + r.id +
                 " has several people who touch on ground that tilts, about where each of them "
                 "stands; fit with --interaction=none, or leave the recording out"};
  }
  return std::nullopt;
}

MaybeError CheckPlates(const PendulumRecording& r, const FitOptions& options) {
  if (!r.HasPlates()) return std::nullopt;
  const ModelOptions& model = options.model;
  const std::string where = "recording " + r.id + " has force_plates to be measured against";
  if (RodMoves(model)) {
    return Error{where +
                 ", which know nothing of a rod that moves; leave --rod out, or set \"use\": "
                 "\"none\" there"};
  }
  if (options.likelihood != Likelihood::kTrajectory) {
    return Error{where + ", which --likelihood=" + NameOf(options.likelihood) +
                 " does not have: it knows positions alone; set \"use\": \"none\" there, or fit "
                 "with --likelihood=trajectory; " +
                 kQuestions};
  }
  if (model.interaction.Any() && r.num_people() > 1) {
    return Error{"recording " + r.id +
                 " has force_plates and several people who touch: platforms cannot tell what they "
                 "do to each other from what the ground does; set \"use\": \"none\" there, or fit "
                 "with --interaction=none"};
  }
  return std::nullopt;
}

// Where nobody saw the motion, only what platforms measure is compared.
MaybeError CheckPlatesAlone(const PendulumRecording& r, const FitOptions& options) {
  if (r.IsSeen()) return std::nullopt;
  const ModelOptions& model = options.model;
  const std::string whose =
      "recording " + r.id + " was measured by force plates alone (\"motion\": \"none\")";
  if (model.stance != Stance::kFixed) {
    return Error{whose + ", which tell nothing of feet that slide or step; add --stance=fixed"};
  }
  if (model.body != BodyModel::kLdp || RodMoves(model) || NeedsGradientTraining(options)) {
    return Error{whose +
                 ", from which neither bodies, rods nor large networks are learnt; leave --body, "
                 "--rod and the network out"};
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckLaboratory(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options) {
  if (MaybeError error = CheckDelay(recordings, options)) return error;
  if (MaybeError error = CheckBodyModel(options)) return error;
  const bool large = NeedsGradientTraining(options);
  if (large && (options.model.delay != Delay::kNone || options.model.body == BodyModel::kTable)) {
    return Error{
        "networks of this size are trained by their gradient, which knows neither --delay nor "
        "--body=table; leave them out, or take a smaller network"};
  }
  for (const PendulumRecording& r : recordings) {
    if (MaybeError error = CheckGround(r, options.model)) return error;
    if (MaybeError error = CheckPlates(r, options)) return error;
    if (MaybeError error = CheckPlatesAlone(r, options)) return error;
    if (large && (r.scene.ground.moves() || r.HasPlates())) {
      return Error{"recording " + r.id +
                   " has moving ground or force_plates, and the network is of a size that is "
                   "trained by its gradient, which knows neither; take a smaller network, or leave "
                   "the recording out"};
    }
  }
  return std::nullopt;
}

}  // namespace pushid
