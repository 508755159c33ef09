// ident: the presets of a fit (--preset says what each is for), and the parameters that a model
// frees.
//
//   tail          eight free parameters, the tail's base partially pooled by condition
//   group         where feet step, contact and tail are partially pooled by setting, sixteen shared
//                 parameters; where they slide, all but mu, eighteen shared ones
//   robot         PD gains in N m/rad and N m s/rad, the same in all directions, without priors
//   ldp           five free parameters
//   ldp_published its networks and mu; of groups (ldp_published_groups) also potential, torques and
//                 a network on every neighbour (Yue et al., CVPR 2024)
//
//   FitOptions options = MakePreset("tail").value();
//   options.model.friction = FrictionKind::kAnisotropic;
//   FreeTerms(&options);                  // the terms have changed
//   options.table[kMuY].free = true;      // held otherwise
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

inline constexpr char kAutoPreset[] = "auto";

// The preset that "auto" and "ldp_published" stand for on these recordings; other names stay.
std::string PresetFor(const std::string& name, const std::vector<PendulumRecording>& recordings);

// Whether gains are those of the one body that was recorded, whatever its mass and height.
inline bool IsOneMachine(const ModelOptions& model) {
  return model.stance == Stance::kFixed && model.gain_scaling == GainScaling::kNone;
}

// Complete and ready for PrepareFit. Errors: no such preset (auto is none before PresetFor).
Result<FitOptions> MakePreset(const std::string& name);

// The preset before FreeTerms and PoolParameters: only its own parameters are free.
Result<FitOptions> StartPreset(const std::string& name);

// Frees the parameters of the terms that the options have, with weak priors as wide as their
// centres (none without preset_priors), and holds those of terms that they do not have. What was
// free before and acts stays free. Pools all or none of them where options->pool says so.
void FreeTerms(FitOptions* options);

// Pools what options->pool names, and nothing else. Errors: unknown, fixed, or shared by two
// people.
MaybeError PoolParameters(FitOptions* options);

// Sets the behaviour of the feet and all that follows from it: where they hold and step, pushes act
// as their kind says (a `net` push holds the feet's reaction), and the balance gains are the
// ankles'. Where they hold whatever happens, pushes have no tail, people are not held to settle,
// and both gains of both directions are free. Unless told which, a preset takes the stance from
// what the feet did (PushedFeet), and has one for people who nearly all move: of people alone feet
// slide, of people who touch they step, each the one that predicts them better (models/README.md).
// Presets that stand for something published have none (nullopt) and slide.
inline constexpr char kAutoStance[] = "auto";
std::optional<Stance> StanceOfMovers(const std::string& preset);
void SetStance(Stance stance, FitOptions* options);

// Whether people's joints are needed besides hip and ankles: for masses by segments, and bodies.
inline bool NeedsJoints(const ModelOptions& model) {
  return model.body == BodyModel::kAnthropometric;
}

// Sets the likelihood that the fit maximizes. One of single steps has process noise, and demands
// nothing of people in simulations: these see rollouts, which it does not fit.
void SetLikelihood(Likelihood likelihood, FitOptions* options);

// The part of a model that has a state besides place and velocity, as a flag; empty: none.
// Likelihoods of single steps are for models without.
std::string MemoryOf(const ModelOptions& model);

// Sets where a body's mass is. By the table, it starts as a point at the hip, with nothing free.
void SetBody(BodyModel body, FitOptions* options);

// Sets the delay; where there is one, its parameters are free, with weak priors.
void SetDelay(Delay delay, FitOptions* options);

inline constexpr double kLdpRate = 60.0;  // Hz: LDP counts Kd per frame

// The feet of pushed people in recordings, and the stance that a fit takes from them.
//
//   PushedFeet feet = FeetOf(recordings);
//   StanceOf(feet, Stance::kSlide)  // kFixed: nobody's feet moved

// Pushed people whose feet were recorded; who is pushed in two recordings counts twice.
struct PushedFeet {
  int seen = 0;
  int moved = 0;    // stepped, or were elsewhere at the end (PersonSteps::Moved)
  int stepped = 0;  // a foot left the ground (foot_steps.h) while the other did not
};

// 1/s: in longer frames a foot is in the air for less than ten (models/stance.h).
inline constexpr double kLeastSteppingRate = 29.0;

PushedFeet FeetOf(const std::vector<PendulumRecording>& recordings);

// The stance of a fit by what feet did. Nobody moved: fixed. Fewer than half of those who moved
// lifted a foot, or nobody's feet were recorded: slide. Three in four moved: of_movers. Else:
// steps.
Stance StanceOf(const PushedFeet& feet, Stance of_movers);

// "feet hold (--stance=fixed; they moved in 0 of 24 pushes)"; empty: no feet were recorded.
std::string FeetText(const PushedFeet& feet, Stance stance);

// A warning where the stance contradicts the recorded feet; empty: none.
std::string FeetWarning(const PushedFeet& feet, Stance stance);

}  // namespace pushid
