// ident: what a model learns (a self force, a law of the rod, an interaction) as words of a command
// line, as first weights, and as JSON.
//
//   mlp:4, gru:8, lstm:16           kind and hidden size (4 where it is left out)
//   lstm:256:32                     with an embedding of 32 before it
//   ldp:256:32                      LDP's, with biases and the mass; it always has an embedding
//   constant, linear, mlp:4, ldp:128-128                          a law of the rod
//   network:8-8, ldp_network:512-512, among the terms of an interaction    hidden sizes
// JSON: {"kind": "gru", "hidden": 8, "embedding": 0,
//        "rod": {"kind": "mlp", "hidden": [4]}, "interaction": {"hidden": [4], "ldp": false},
//        "weights": [...]}
// weights: the flat array of models/learned_terms.h, without loss. Kind none, and no interaction,
// where those are not learned.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "datasets/files/error.h"
#include "ident/parameters/parameter_table.h"
#include "models/learned_terms.h"

namespace pushid {

inline constexpr int kLargestSize = 4096;  // of a layer
inline constexpr size_t kMostLayers = 8;

// The value of --self_force: none, linear, a network, or "linear,gru:4". What is not named is none.
struct SelfForceChoice {
  SelfForceKind kind = SelfForceKind::kNone;
  NetworkShape network;
};
Result<SelfForceChoice> ParseSelfForce(const std::string& flag, const std::string& text);
std::string SelfForceText(SelfForceKind kind, const LearnedTerms* network);
// One of each kind of network, and one with an embedding at the end, for help and messages.
std::vector<std::string> NetworkExamples();

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

// "gru:4", "rod linear", "gru:4 and rod mlp:4", "interaction network:4".
std::string LearnedName(const LearnedTerms& network);

// Random hidden weights (variance 1 / inputs of the unit) and no output: no force and a rod that
// stays, but gradients to leave that by. The forget gates of an LSTM start open.
std::vector<double> InitialWeights(const NetworkShape& shape, uint64_t seed);
std::shared_ptr<const LearnedTerms> InitialNetwork(const NetworkShape& shape, uint64_t seed,
                                                   const RodShape& rod = {},
                                                   const PairShape& pair = {});

nlohmann::ordered_json ToJson(const LearnedTerms& network);
// Throws std::runtime_error that says what is wrong: an unknown kind, nothing that is learned, a
// number of weights that does not follow from the sizes, weights that are not finite.
std::shared_ptr<const LearnedTerms> LearnedFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
