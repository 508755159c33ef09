// ident: self-force networks by name, by seed and by file.
#include "ident/self_network_io.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "datasets/random.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDefaultHidden = 4;
constexpr int kLargestSize = 4096;
constexpr double kOpenForgetGate = 1.0;

const char* const kKinds[] = {"none", "mlp", "gru", "lstm"};

// The kind of that name; kNone for any other.
NetworkKind KindOf(const std::string& name) {
  for (NetworkKind kind : {NetworkKind::kMlp, NetworkKind::kGru, NetworkKind::kLstm}) {
    if (name == kKinds[static_cast<int>(kind)]) return kind;
  }
  return NetworkKind::kNone;
}

// A size between 1 and kLargestSize, or 0.
int Size(const std::string& text) {
  if (text.empty() || text.size() > 4 ||
      text.find_first_not_of("0123456789") != std::string::npos) {
    return 0;
  }
  const int size = std::stoi(text);
  return size <= kLargestSize ? size : 0;
}

Result<NetworkShape> ParseNetwork(const std::string& flag, const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream list(text);
  for (std::string part; std::getline(list, part, ':');) parts.push_back(part);
  NetworkShape shape;
  shape.kind = parts.empty() ? NetworkKind::kNone : KindOf(parts[0]);
  shape.hidden = kDefaultHidden;
  const bool known =
      shape.any() && text.back() != ':' && parts.size() <= (shape.recurrent() ? 3 : 2);
  if (parts.size() > 1) shape.hidden = Size(parts[1]);
  if (parts.size() > 2) shape.embedding = Size(parts[2]);
  if (known && shape.hidden > 0 && (parts.size() < 3 || shape.embedding > 0)) return shape;
  return Error{flag + " is '" + text +
               "'; it must be none, linear, mlp:4, gru:4, lstm:4 or lstm:256:32 (hidden size, "
               "embedding; 1 to " +
               std::to_string(kLargestSize) + "), or linear and a network, as linear,gru:4"};
}

}  // namespace

Result<SelfForceChoice> ParseSelfForce(const std::string& flag, const std::string& text) {
  SelfForceChoice choice;
  std::stringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    if (part == "none") continue;
    if (part == "linear") {
      choice.kind = SelfForceKind::kLinear;
      continue;
    }
    if (choice.network.any()) return Error{flag + " names more than one network"};
    const Result<NetworkShape> shape = ParseNetwork(flag, part);
    if (!shape.ok()) return shape.error();
    choice.network = shape.value();
  }
  return choice;
}

std::string SelfForceText(SelfForceKind kind, const SelfNetwork* network) {
  if (network == nullptr) return kind == SelfForceKind::kLinear ? "linear" : "none";
  return (kind == SelfForceKind::kLinear ? "linear," : "") + NetworkName(network->shape);
}

std::vector<double> InitialWeights(const NetworkShape& shape, uint64_t seed) {
  Random random(seed);
  std::vector<double> weights(shape.num_weights(), 0.0);
  const auto fill = [&](int first, int last, int fan_in) {
    for (int i = first; i < last; ++i) weights[i] = random.Normal() / std::sqrt(fan_in);
  };
  fill(0, shape.gates_at(), shape.num_inputs());
  fill(shape.gates_at(), shape.candidates_at(), shape.gate_width());
  fill(shape.candidates_at(), shape.output_at(), std::max(1, shape.candidate_width()));
  if (shape.kind == NetworkKind::kLstm) {
    for (int row = shape.hidden; row < 2 * shape.hidden; ++row) {
      weights[shape.gates_at() + (row + 1) * shape.gate_width() - 1] += kOpenForgetGate;
    }
  }
  return weights;
}

std::shared_ptr<const SelfNetwork> InitialNetwork(const NetworkShape& shape, uint64_t seed) {
  return std::make_shared<const SelfNetwork>(SelfNetwork{shape, InitialWeights(shape, seed)});
}

Json ToJson(const SelfNetwork& network) {
  const NetworkShape& s = network.shape;
  return {{"kind", kKinds[static_cast<int>(s.kind)]},
          {"hidden", s.hidden},
          {"embedding", s.embedding},
          {"rod_input", s.rod_input},
          {"weights", network.weights}};
}

std::shared_ptr<const SelfNetwork> SelfNetworkFromJson(const Json& json) {
  SelfNetwork network;
  NetworkShape& s = network.shape;
  const std::string kind = json.at("kind");
  s.kind = KindOf(kind);
  if (!s.any()) throw std::runtime_error("network: '" + kind + "' is no kind (mlp, gru, lstm)");
  s.hidden = json.at("hidden");
  s.embedding = json.at("embedding");
  s.rod_input = json.at("rod_input");
  if (s.hidden < 1 || s.hidden > kLargestSize || s.embedding < 0 || s.embedding > kLargestSize) {
    throw std::runtime_error("network: sizes must lie between 1 and " +
                             std::to_string(kLargestSize));
  }
  network.weights = json.at("weights").get<std::vector<double>>();
  if (static_cast<int>(network.weights.size()) != s.num_weights()) {
    throw std::runtime_error("network: " + NetworkName(s) + " has " +
                             std::to_string(s.num_weights()) + " weights, not " +
                             std::to_string(network.weights.size()));
  }
  for (double weight : network.weights) {
    if (!std::isfinite(weight)) throw std::runtime_error("network: a weight is not finite");
  }
  return std::make_shared<const SelfNetwork>(std::move(network));
}

}  // namespace pushid
