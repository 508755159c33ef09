// ident: settings of the models, and what follows from a model: which parameters are fitted.
//
//   tail:  one person: push tail, posture-relative recovery, one cross term; eight free
//          parameters, the tail's base partially pooled by condition
//   robot: a machine whose feet hold: PD gains in N m/rad and N m s/rad, the same in all
//   directions,
//          without priors; its mass as the manifest states it (com_over_rod, gyration_over_rod)
//   ldp:   one person: plain PD balance and one friction from upright; five free parameters
//   group: people who touch: tail with contact. Where feet step contact and tail are partially
//          pooled by setting (condition), sixteen shared parameters; where they slide there are all
//          linear self forces, and every parameter but mu is, eighteen shared ones
//   ldp_published: LDP as published (Yue et al., CVPR 2024), networks and all: PD and friction at
//          all times, an LSTM as self force, a law of the rod; between people
//          (ldp_published_groups, which it stands for where there are several) also potential,
//          torques and a network on every neighbour
//   auto:  tail where every recording is of one person, otherwise group
//
//   FitOptions options = MakePreset("tail").value();
//   options.model.friction = FrictionKind::kAnisotropic;
//   FreeTerms(&options);                  // the terms have changed
//   options.table[kMuY].free = true;      // held otherwise
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"
#include "models/options.h"

namespace pushid {

inline constexpr char kAutoPreset[] = "auto";

// What "auto" and "ldp_published" stand for on these recordings; other names as they are.
std::string PresetFor(const std::string& name, const std::vector<PendulumRecording>& recordings);

// Whether gains are those of the one body that was recorded, whatever its mass and height.
inline bool IsOneMachine(const ModelOptions& model) {
  return model.stance == Stance::kFixed && model.gain_scaling == GainScaling::kNone;
}

// Complete and ready for PrepareFit. Errors: no such preset (auto is none before PresetFor).
Result<FitOptions> MakePreset(const std::string& name);

// As MakePreset before FreeTerms and PoolParameters: only the preset's own parameters are free.
Result<FitOptions> StartPreset(const std::string& name);

// Frees the parameters of the terms that the options have, with weak priors as wide as their
// centres (none without preset_priors), and holds those of terms that they do not have. What was
// free before and acts stays free. Pools all or none of them where options->pool says so.
void FreeTerms(FitOptions* options);

// Pools what options->pool names, and nothing else. Errors: unknown, fixed, or shared by two
// people.
MaybeError PoolParameters(FitOptions* options);

// What the feet do, with what goes with it: where they hold and step, pushes act as their kind says
// (a `net` push holds the feet's reaction), and the balance gains are the ankles'. Where they hold
// whatever happens, pushes have no tail, people are not held to settle, and both gains of both
// directions are free.
// Unless told which, a preset takes the stance from what the feet did (PushedFeet), and has one
// for people who nearly all move: of people alone feet slide, of people who touch they step, each
// the one that predicts them better (models/README.md). Presets that stand for something published
// have none (nullopt) and slide.
inline constexpr char kAutoStance[] = "auto";
std::optional<Stance> StanceOfMovers(const std::string& preset);
void SetStance(Stance stance, FitOptions* options);

// Whether people's joints are needed besides hip and ankles: for masses by segments, and bodies.
inline bool NeedsJoints(const ModelOptions& model) {
  return model.body == BodyModel::kAnthropometric;
}

// What the fit maximizes. A likelihood of single steps has process noise,
// and demands nothing of people in simulations: these see rollouts, which it does not fit.
void SetLikelihood(Likelihood likelihood, FitOptions* options);

// What of a model has a state besides place and velocity, as its flag is called; empty: nothing.
// Likelihoods of single steps are for models without.
std::string MemoryOf(const ModelOptions& model);

// Masses by the table: the point at the hip to start from, nothing free.
void SetBody(BodyModel body, FitOptions* options);

// With a delay its parameters are free, with weak priors.
void SetDelay(Delay delay, FitOptions* options);

inline constexpr double kLdpRate = 60.0;  // Hz: LDP counts Kd per frame

// What the feet of pushed people did, and which stance a fit takes from that.
//
//   PushedFeet feet = FeetOf(recordings);
//   StanceOf(feet, Stance::kSlide)  // kFixed: nobody's feet moved
//   FeetText(feet, stance)    // "feet hold (--stance=fixed; they moved in 0 of 24 pushes)"

// Pushed people whose feet were recorded; who is pushed in two recordings counts twice.
struct PushedFeet {
  int seen = 0;
  int moved = 0;    // stepped, or were elsewhere at the end (PersonSteps::Moved)
  int stepped = 0;  // a foot left the ground (foot_steps.h) while the other did not
};

// 1/s: in longer frames a foot is in the air for less than ten (models/stance.h).
inline constexpr double kLeastSteppingRate = 29.0;

PushedFeet FeetOf(const std::vector<PendulumRecording>& recordings);

// Nobody moved: fixed. Fewer than half of who moved lifted a foot, or nobody's feet were recorded:
// slide. Three in four moved: of_movers. Else: steps.
Stance StanceOf(const PushedFeet& feet, Stance of_movers);

// What the feet of a model do and what those of the recordings did; empty: none were recorded.
std::string FeetText(const PushedFeet& feet, Stance stance);

// What to warn of where the two contradict each other; empty: nothing.
std::string FeetWarning(const PushedFeet& feet, Stance stance);

}  // namespace pushid
