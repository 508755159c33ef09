// ident: self-force networks as words of a command line, as first weights, and as JSON.
//
//   mlp:4, gru:8, lstm:16           kind and hidden size (4 where it is left out)
//   lstm:256:32                     with an embedding of 32 before it
// JSON: {"kind": "gru", "hidden": 8, "embedding": 0, "rod_input": false, "weights": [...]}, the
// flat array of models/self_network.h, without loss.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "datasets/result.h"
#include "ident/parameter_table.h"
#include "models/self_network.h"

namespace pushid {

// The value of --self_force: none, linear, a network, or "linear,gru:4". What is not named is none.
struct SelfForceChoice {
  SelfForceKind kind = SelfForceKind::kNone;
  NetworkShape network;
};
Result<SelfForceChoice> ParseSelfForce(const std::string& flag, const std::string& text);
std::string SelfForceText(SelfForceKind kind, const SelfNetwork* network);

// Random hidden weights (variance 1 / inputs of the unit) and no output: no force, but gradients to
// leave that by. The forget gates of an LSTM start open.
std::vector<double> InitialWeights(const NetworkShape& shape, uint64_t seed);
std::shared_ptr<const SelfNetwork> InitialNetwork(const NetworkShape& shape, uint64_t seed);

nlohmann::ordered_json ToJson(const SelfNetwork& network);
// Throws std::runtime_error that says what is wrong: an unknown kind, a number of weights that does
// not follow from the sizes, weights that are not finite.
std::shared_ptr<const SelfNetwork> SelfNetworkFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
