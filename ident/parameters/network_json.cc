// ident: interaction networks in and out of JSON.
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "ident/parameters/learned_terms_io.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> ToVector(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

Eigen::VectorXd Numbers(const Json& json, const std::string& what) {
  const auto values = json.get<std::vector<double>>();
  for (double value : values) {
    if (!std::isfinite(value))
      throw std::runtime_error(what + " contains a number that is not finite");
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd Sized(const Json& json, const char* key, int size) {
  const Eigen::VectorXd v = Numbers(json.at(key), key);
  if (v.size() != size) {
    throw std::runtime_error(std::string(key) + " has " + std::to_string(v.size()) +
                             " numbers; it must have " + std::to_string(size));
  }
  return v;
}

MlpLayer Layer(const Json& json, const std::string& name, Eigen::Index inputs) {
  MlpLayer layer;
  layer.bias = Numbers(json.at("bias"), name + " bias");
  const Json& rows = json.at("weights");
  if (static_cast<Eigen::Index>(rows.size()) != layer.bias.size() || rows.empty()) {
    throw std::runtime_error(name + " has " + std::to_string(rows.size()) +
                             " rows of weights and " + std::to_string(layer.bias.size()) +
                             " biases; as many are needed");
  }
  layer.weights.resize(layer.bias.size(), inputs);
  for (Eigen::Index i = 0; i < layer.weights.rows(); ++i) {
    const Eigen::VectorXd row = Numbers(rows[i], name + " weights");
    if (row.size() != inputs) {
      throw std::runtime_error(name + ": row " + std::to_string(i) + " has " +
                               std::to_string(row.size()) + " weights; " + std::to_string(inputs) +
                               " come in");
    }
    layer.weights.row(i) = row.transpose();
  }
  return layer;
}

}  // namespace

nlohmann::ordered_json ToJson(const InteractionNetwork& network) {
  Json layers = Json::array();
  for (const MlpLayer& layer : network.mlp.layers) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < layer.weights.rows(); ++i) {
      rows.push_back(ToVector(layer.weights.row(i).transpose()));
    }
    layers.push_back({{"weights", rows}, {"bias", ToVector(layer.bias)}});
  }
  Json json = {{"activation", NameOf(network.mlp.activation)},
               {"layers", layers},
               {"input_mean", ToVector(network.mean)},
               {"input_deviation", ToVector(network.deviation)},
               {"output_scale", ToVector(network.scale)},
               {"output_offset", ToVector(network.offset)}};
  if (network.lowest) json["output_lowest"] = ToVector(*network.lowest);
  if (network.highest) json["output_highest"] = ToVector(*network.highest);
  return json;
}

std::shared_ptr<const InteractionNetwork> InteractionNetworkFromJson(const Json& json) {
  auto network = std::make_shared<InteractionNetwork>();
  if (MaybeError error = ParseName("activation", json.at("activation").get<std::string>(),
                                   &network->mlp.activation)) {
    throw std::runtime_error(error->message);
  }
  Eigen::Index inputs = kNetworkInputs;
  for (const Json& layer : json.at("layers")) {
    const std::string name = "layer " + std::to_string(network->mlp.layers.size());
    network->mlp.layers.push_back(Layer(layer, name, inputs));
    inputs = network->mlp.layers.back().bias.size();
  }
  if (network->mlp.layers.empty() || inputs != 4) {
    throw std::runtime_error("the last layer has " + std::to_string(inputs) +
                             " outputs; it must have 4: Fx, Fy, Ftheta, Fphi");
  }
  network->mean = Sized(json, "input_mean", kNetworkInputs);
  network->deviation = Sized(json, "input_deviation", kNetworkInputs);
  if (!(network->deviation.minCoeff() > 0.0)) {
    throw std::runtime_error("input_deviation must be positive");
  }
  network->scale = Sized(json, "output_scale", 4);
  network->offset = Sized(json, "output_offset", 4);
  if (json.contains("output_lowest")) network->lowest = Sized(json, "output_lowest", 4);
  if (json.contains("output_highest")) network->highest = Sized(json, "output_highest", 4);
  return network;
}

Result<std::shared_ptr<const InteractionNetwork>> ReadInteractionNetwork(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  try {
    return InteractionNetworkFromJson(document.value().content);
  } catch (const std::exception& exception) {
    return Error{std::string("this is not an interaction network: ") + exception.what(), path};
  }
}

namespace {

using Json = nlohmann::ordered_json;

void CheckSizes(const std::string& what, const std::vector<int>& hidden) {
  for (int size : hidden) {
    if (size >= 1 && size <= kLargestSize) continue;
    throw std::runtime_error(what + ": sizes must lie between 1 and " +
                             std::to_string(kLargestSize));
  }
}

RodShape RodFromJson(const Json& json) {
  const std::string kind = json.at("kind");
  const std::optional<RodKind> known = FromName<RodKind>(kind);
  if (!known) {
    throw std::runtime_error("rod: '" + kind + "' is not a kind (" +
                             Listed(AllNames<RodKind>(), ",") + ")");
  }
  const RodShape rod{*known, json.at("hidden").get<std::vector<int>>()};
  const bool layers_fit =
      rod.layered() ? !rod.hidden.empty() && rod.hidden.size() <= kMostLayers : rod.hidden.empty();
  if (!layers_fit) throw std::runtime_error("rod: no " + kind + " has so many layers");
  CheckSizes("rod", rod.hidden);
  return rod;
}

PairShape PairFromJson(const Json& json) {
  PairShape pair{json.at("hidden").get<std::vector<int>>(), json.value("ldp", false)};
  if (!pair.any() || pair.hidden.size() > kMostLayers) {
    throw std::runtime_error("interaction: a network has one to " + std::to_string(kMostLayers) +
                             " hidden layers");
  }
  CheckSizes("interaction", pair.hidden);
  return pair;
}

}  // namespace

Json ToJson(const LearnedTerms& network) {
  const NetworkShape& s = network.shape;
  Json json = {{"kind", NameOf(s.kind)},
               {"hidden", s.hidden},
               {"embedding", s.embedding},
               {"rod", {{"kind", NameOf(network.rod.kind)}, {"hidden", network.rod.hidden}}},
               {"weights", network.weights}};
  if (network.pair.any()) {
    json["interaction"] = {{"hidden", network.pair.hidden}, {"ldp", network.pair.ldp}};
  }
  return json;
}

std::shared_ptr<const LearnedTerms> LearnedFromJson(const Json& json) {
  LearnedTerms network;
  NetworkShape& s = network.shape;
  const std::string kind = json.at("kind");
  if (const std::optional<NetworkKind> known = FromName<NetworkKind>(kind)) {
    s.kind = *known;
  } else {
    throw std::runtime_error("network: '" + kind + "' is not a kind (" +
                             Listed(AllNames<NetworkKind>(), ",") + ")");
  }
  if (json.contains("rod")) network.rod = RodFromJson(json.at("rod"));
  if (json.contains("interaction")) network.pair = PairFromJson(json.at("interaction"));
  if (!network.any()) throw std::runtime_error("network: nothing is learned");
  for (const char* size : {"hidden", "embedding"}) {
    if (!json.at(size).is_number_integer()) {
      throw std::runtime_error(std::string("network: ") + size + " must be a whole number");
    }
  }
  s.hidden = json.at("hidden");
  s.embedding = json.at("embedding");
  if (json.value("rod_input", false)) {
    throw std::runtime_error("network: rod_input, an option of earlier versions, is gone");
  }
  if (s.hidden < (s.any() ? 1 : 0) || s.hidden > kLargestSize || s.embedding < s.biased() ||
      s.embedding > kLargestSize) {
    throw std::runtime_error("network: sizes must lie between 1 and " +
                             std::to_string(kLargestSize));
  }
  network.weights = json.at("weights").get<std::vector<double>>();
  if (static_cast<int>(network.weights.size()) != network.num_weights()) {
    throw std::runtime_error("network: " + LearnedName(network) + " has " +
                             std::to_string(network.num_weights()) + " weights, not " +
                             std::to_string(network.weights.size()));
  }
  for (double weight : network.weights) {
    if (!std::isfinite(weight)) throw std::runtime_error("network: a weight is not finite");
  }
  return std::make_shared<const LearnedTerms>(std::move(network));
}

}  // namespace pushid
