// ident: learned terms in and out of JSON.
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "datasets/files/names.h"
#include "ident/parameters/learned_terms_io.h"

namespace pushid {
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
