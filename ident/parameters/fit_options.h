// ident: the options of a fit, and before them the terms that a model learns (a self force, a law
// of the rod, an interaction), as words of a command line, as first weights, and as JSON.
//
//   mlp:4                           kind and hidden size (4 where it is left out)
//   ldp:256:32                      LDP's, with biases, the mass and an embedding
//   constant, ldp:128-128                                         a law of the rod
//   network:8-8, ldp_network:512-512, among the terms of an interaction    hidden sizes
// JSON: {"kind": "mlp", "hidden": 8, "embedding": 0,
//        "rod": {"kind": "ldp", "hidden": [4]}, "interaction": {"hidden": [4], "ldp": false},
//        "weights": [...]}
// weights: the flat array of models/learned_terms.h, without loss. Kind none, and no interaction,
// where those are not learned.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/names.h"
#include "ident/parameters/parameter_table.h"
#include "models/learned_terms.h"
#include "residuals/frame_residual.h"

namespace pushid {

inline constexpr int kLargestSize = 4096;  // of a layer
inline constexpr size_t kMostLayers = 8;

// The value of --self_force: none, linear, a network, or "linear,mlp:4". What is not named is none.
struct SelfForceChoice {
  SelfForceKind kind = SelfForceKind::kNone;
  NetworkShape network;
};
Result<SelfForceChoice> ParseSelfForce(const std::string& flag, const std::string& text);
std::string SelfForceText(SelfForceKind kind, const LearnedTerms* network);

// The value of --rod.
Result<RodShape> ParseRod(const std::string& flag, const std::string& text);

// The value of --interaction: none, or terms by name, comma-separated ("contact" is short
// for spring and damping), and at most one network.
struct InteractionChoice {
  InteractionTerms terms;
  PairShape pair;
};
Result<InteractionChoice> ParseInteraction(const std::string& flag, const std::string& text);
std::string InteractionText(const ModelOptions& options);

// "mlp:4", "rod ldp:4", "mlp:4 and rod ldp:4", "interaction network:4".
std::string LearnedName(const LearnedTerms& network);

// Random hidden weights (variance 1 / inputs of the unit) and no output: no force and a rod that
// stays, but gradients to leave that by. The forget gates of LDP's LSTM start open.
std::vector<double> InitialWeights(const NetworkShape& shape, uint64_t seed);
std::shared_ptr<const LearnedTerms> InitialNetwork(const NetworkShape& shape, uint64_t seed,
                                                   const RodShape& rod = {},
                                                   const PairShape& pair = {});

nlohmann::ordered_json ToJson(const LearnedTerms& network);
// Throws std::runtime_error that says what is wrong: an unknown kind, a rod that there is not,
// nothing that is learned, a number of weights that does not follow from the sizes, weights that
// are not finite.
std::shared_ptr<const LearnedTerms> LearnedFromJson(const nlohmann::ordered_json& json);

// Options of a fit. Every field says what it changes and when you would change it.

// The unit whose errors are independent of each other.
enum class ClusterBy {
  kAuto,      // people where some were recorded more than once, otherwise recordings
  kSubject,   // people; where several share a recording, people and line-ups (two-way)
  kRecording  // recordings
};
constexpr EnumNames<ClusterBy, 3> Names(ClusterBy) {
  return {{{"auto", ClusterBy::kAuto},
           {"subject", ClusterBy::kSubject},
           {"recording", ClusterBy::kRecording}}};
}

struct FitOptions {
  std::string preset = "tail";  // it was made from (presets.h)
  SelfForceKind self_force = SelfForceKind::kNone;
  ModelOptions model;
  ParameterTable table;
  bool preset_priors = true;  // false: FreeTerms takes the weak priors away

  Likelihood likelihood = Likelihood::kTrajectory;  // by SetLikelihood (presets.h)
  // Derivatives of the recordings' rollouts: kAutodiff checks the quick ones.
  DerivativesBy derivatives = DerivativesBy::kAuto;

  // Where they are estimated: where the estimation starts, and in a result what it found.
  ResidualSigmas sigmas;
  double marker_noise = 0.001;  // m, of hip and ankles: no residual counts as more exact
  // Independent frames per frame (uncertainty/covariance.h): found by the fit; 0: not yet, every
  // recording counts as one frame.
  double effective_weight = 0.0;
  // False: sigmas and effective weight stay as they are given.
  bool estimate_weights = true;
  // Weight of the demand that people settle (cost_functions/rest_residual.h), which the data may
  // contradict (fit/fit.h): 0: none.
  double settling_weight = 0.0;
  // Parameters that may differ by unit: names, comma-separated, "all", "all,-mu" (all but mu)
  // or "none".
  std::string pool = "none";
  std::string pool_by = kSubjectUnit;  // the unit they may differ by
  // Standard deviation of a unit's deviation from the shared value, on the fitted scale (0.2 on
  // a log scale is about 20 %); none: estimated from the units (problem/fit_problem.cc).
  // PoolParameters gives it to the pooled parameters.
  std::optional<double> pooling_sigma;

  // A label, between whose two values every free parameter is compared; empty: none. And
  // covariates as --covariate spells them: "Kp_theta ~ age + height; Kd_theta ~ age". PrepareFit
  // makes their slopes rows of the table (fit/covariates.h).
  std::string contrast, covariates;

  // Standard deviation of the prior that ties the weights of learned terms (they start as in
  // `model`) to zero; 0: none. Smaller where it does not predict better than none.
  double network_prior = 1.0;
  bool hold_network = false;  // its weights are taken as they are

  // Frames rolled out in each stage; 0 means all. Short horizons first keep the path from wandering
  // off while the gains are still wrong.
  std::vector<int> horizons = {8, 16, 32, 64, 0};
  uint64_t seed = 1;
  int num_threads = 1;

  // Ceres; the defaults reach the optimum to a thousandth of a standard error.
  int max_iterations = 200;
  double function_tolerance = 1e-8;
  double gradient_tolerance = 1e-12;
  double parameter_tolerance = 1e-9;

  // Whether a fit could use them; `error` says which option has which value and what it must be.
  bool IsValid(std::string* error) const;
};

// LDP's loss weights all states alike, by the sigmas that it is given.
inline bool EstimatesSigmas(const FitOptions& options) {
  return options.estimate_weights && options.sigmas.loss != FrameLoss::kLdp;
}

// More weights than these are trained by their gradient alone: a Jacobian of the 32 single-person
// recordings would hold 20,000 rows of them.
inline constexpr int kMostGaussNewtonWeights = 2000;
bool IsLarge(const FitOptions& options);
// Whether a large network has yet to be trained.
inline bool NeedsGradientTraining(const FitOptions& options) {
  return !options.hold_network && IsLarge(options);
}

// The options and the parameter table as JSON.
nlohmann::ordered_json OptionsJson(const FitOptions& options);
nlohmann::ordered_json TableJson(const ParameterTable& table);

// Throw what nlohmann's JSON throws for what is missing or of another type, and std::runtime_error
// for unknown names. Of what was learned they have the shapes alone (ToJson of what is learned has
// the weights and the rod's law).
FitOptions OptionsFrom(const nlohmann::ordered_json& json);
// known: every parameter there is; those that the JSON does not name stay.
ParameterTable TableFrom(const nlohmann::ordered_json& json, const ParameterTable& known);

}  // namespace pushid
