// ident: what a delay, moving ground, platforms and other bodies ask of recordings.
#include <algorithm>

#include "datasets/files/number_text.h"
#include "ident/fit/fit_setup.h"
#include "ident/parameters/option_names.h"
#include "models/learned_terms.h"

namespace pushid {
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
                 "with --likelihood=trajectory"};
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
