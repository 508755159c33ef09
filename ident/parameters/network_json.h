// ident: interaction networks as JSON, in a file of their own and inside a model.
//
//   {"activation": "relu", "layers": [{"weights": [[...], ...], "bias": [...]}, ...],
//    "input_mean": [10], "input_deviation": [10], "output_scale": [4], "output_offset": [4],
//    "output_lowest": [4], "output_highest": [4]}
// weights by rows, one per output of the layer; the last two are optional (no clamp).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "datasets/files/error.h"
#include "models/network_interaction.h"

namespace pushid {

nlohmann::ordered_json ToJson(const InteractionNetwork& network);

// Throws std::runtime_error that says what is wrong: sizes that do not follow one another, numbers
// that are not finite, deviations that are not positive.
std::shared_ptr<const InteractionNetwork> InteractionNetworkFromJson(
    const nlohmann::ordered_json& json);

// The same from a file, with the file's name in the error.
Result<std::shared_ptr<const InteractionNetwork>> ReadInteractionNetwork(const std::string& path);

}  // namespace pushid
