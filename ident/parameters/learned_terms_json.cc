// ident: learned terms in and out of JSON.
#include <cmath>
#include <stdexcept>
#include <vector>

#include "ident/parameters/json_archive.h"
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

void CheckRod(const RodShape& rod) {
  const bool layers_fit =
      rod.layered() ? !rod.hidden.empty() && rod.hidden.size() <= kMostLayers : rod.hidden.empty();
  if (!layers_fit) throw std::runtime_error("rod: no " + NameOf(rod.kind) + " has so many layers");
  CheckSizes("rod", rod.hidden);
}

void CheckPair(const PairShape& pair) {
  if (!pair.any() || pair.hidden.size() > kMostLayers) {
    throw std::runtime_error("interaction: a network has one to " + std::to_string(kMostLayers) +
                             " hidden layers");
  }
  CheckSizes("interaction", pair.hidden);
}

}  // namespace

template <class Archive>
void Fields(Archive& a, RodShape& rod) {
  PUSHID_FIELDS(a, rod, kind, hidden);
}

template <class Archive>
void Fields(Archive& a, PairShape& pair) {
  a("hidden", pair.hidden);
  if (a.Has("ldp")) a("ldp", pair.ldp);
}

template <class Archive>
void Fields(Archive& a, LearnedTerms& network) {
  PUSHID_FIELDS(a, network.shape, kind, hidden, embedding);
  if (a.Has("rod")) a("rod", network.rod);
  a("weights", network.weights);
  if (a.Has("interaction", network.pair.any())) a("interaction", network.pair);
}

Json ToJson(const LearnedTerms& network) { return JsonOf(network); }

std::shared_ptr<const LearnedTerms> LearnedFromJson(const Json& json) {
  for (const char* size : {"hidden", "embedding"}) {
    if (!json.at(size).is_number_integer()) {
      throw std::runtime_error(std::string("network: ") + size + " must be a whole number");
    }
  }
  if (json.value("rod_input", false)) {
    throw std::runtime_error("network: rod_input, an option of earlier versions, is gone");
  }
  const auto network = std::make_shared<const LearnedTerms>(FromJson<LearnedTerms>(json));
  const NetworkShape& s = network->shape;
  if (!network->any()) throw std::runtime_error("network: nothing is learned");
  CheckRod(network->rod);
  if (json.contains("interaction")) CheckPair(network->pair);
  if (s.hidden < (s.any() ? 1 : 0) || s.hidden > kLargestSize || s.embedding < s.biased() ||
      s.embedding > kLargestSize) {
    throw std::runtime_error("network: sizes must lie between 1 and " +
                             std::to_string(kLargestSize));
  }
  if (static_cast<int>(network->weights.size()) != network->num_weights()) {
    throw std::runtime_error("network: " + LearnedName(*network) + " has " +
                             std::to_string(network->num_weights()) + " weights, not " +
                             std::to_string(network->weights.size()));
  }
  for (double weight : network->weights) {
    if (!std::isfinite(weight)) throw std::runtime_error("network: a weight is not finite");
  }
  return network;
}

}  // namespace pushid
