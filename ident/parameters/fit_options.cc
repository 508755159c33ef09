// ident: the options of a fit, and learned terms by name, by seed and by file.
#include "ident/parameters/fit_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "datasets/files/random.h"
#include "ident/parameters/json_archive.h"
#include "ident/parameters/option_table.h"

namespace pushid {
namespace {

constexpr int kDefaultHidden = 4;
constexpr double kOpenForgetGate = 1.0;
// So that none repeats the weights of another.
constexpr uint64_t kRodSeed = 7919, kPairSeed = 104729;

constexpr int kLdpHidden = 256, kLdpEmbedding = 32;
constexpr char kLdpRod[] = "128-128";

// A size between 1 and kLargestSize, or 0.
int Size(const std::string& text) {
  std::int64_t size = 0;
  return ParseInteger(text, &size) && size >= 1 && size <= kLargestSize ? static_cast<int>(size)
                                                                        : 0;
}

// "128-128"; empty where it is no list of sizes.
std::vector<int> HiddenSizes(const std::string& text) {
  std::vector<int> hidden;
  for (const std::string& size : SplitList(text, '-')) hidden.push_back(Size(size));
  const bool sound = hidden.size() <= kMostLayers && !EndsWith(text, "-") &&
                     std::count(hidden.begin(), hidden.end(), 0) == 0;
  return sound ? hidden : std::vector<int>();
}

std::string LayersHelp() {
  return " (hidden sizes of 1 to " + std::to_string(kLargestSize) + ", at most " +
         std::to_string(kMostLayers) + " layers)";
}

Result<NetworkShape> ParseNetwork(const std::string& flag, const std::string& text) {
  const std::vector<std::string> parts = SplitList(text, ':');
  NetworkShape shape;
  shape.kind = parts.empty() ? NetworkKind::kNone
                             : FromName<NetworkKind>(parts[0]).value_or(NetworkKind::kNone);
  shape.hidden = shape.ldp() ? kLdpHidden : kDefaultHidden;
  const bool known = shape.any() && text.back() != ':' && parts.size() <= (shape.ldp() ? 3 : 2);
  if (shape.ldp()) shape.embedding = kLdpEmbedding;  // it takes the mass
  if (parts.size() > 1) shape.hidden = Size(parts[1]);
  if (parts.size() > 2) shape.embedding = Size(parts[2]);
  if (known && shape.hidden > 0 && (parts.size() < 3 || shape.embedding > 0)) return shape;
  std::vector<std::string> words = AllNames<SelfForceKind>();
  for (const char* network : {"mlp:4", "ldp:256:32"}) words.push_back(network);
  return Error{flag + " is '" + text + "'; it must be " + Listed(words, "or") +
               " (hidden size, of ldp an embedding; 1 to " + std::to_string(kLargestSize) +
               "), or linear and a network, as linear,mlp:4"};
}

// Rows [W b] of hidden layers.
void AddHiddenWeights(const std::vector<int>& hidden, int inputs, uint64_t seed,
                      std::vector<double>* weights) {
  Random random(seed);
  int width = inputs + 1;
  for (int size : hidden) {
    for (int i = 0; i < size * width; ++i) {
      weights->push_back(random.Normal() / std::sqrt(width));
    }
    width = size + 1;
  }
}

using Json = nlohmann::ordered_json;

// The network that options ask for and that is not there, as a message; empty: none.
std::string MissingNetwork(const FitOptions& o) {
  const auto& network = o.model.learned;
  const bool pair = network != nullptr && network->pair.any();
  if (o.model.interaction.learned_in_range != (pair && network->pair.ldp)) {
    return "--interaction names another network between people than there is";
  }
  if (o.model.interaction.learned != pair) {
    return pair ? "a network between people is there, but --interaction does not name network:SIZES"
                : "--interaction names a network to be fitted, but there is none; name its layers, "
                  "as in --interaction=spring,damping,network:4";
  }
  return "";
}

// The option that does not go together with feet that hold, as a message; empty: none.
std::string StanceViolation(const FitOptions& o) {
  if (o.model.stance == Stance::kSlide) return "";
  const char* sliding = RodMoves(o.model)          ? "--rod"
                        : NeedsGradientTraining(o) ? "a network that is trained by its gradient"
                        : o.model.push != PushUse::kAsRecorded             ? "a push that is added"
                        : o.model.cart_derivative != CartDerivative::kNone ? "the cart's derivative"
                                                                           : nullptr;
  if (sliding == nullptr) return "";
  return std::string(sliding) + " is for feet that slide and does not go together with --stance=" +
         NameOf(o.model.stance) + "; drop one of the two";
}

}  // namespace

Result<SelfForceChoice> ParseSelfForce(const std::string& flag, const std::string& text) {
  SelfForceChoice choice;
  for (const std::string& part : SplitList(text, ',')) {
    if (const auto law = FromName<SelfForceKind>(part)) {
      if (*law == SelfForceKind::kNone || *law == choice.kind) continue;
      if (choice.kind != SelfForceKind::kNone) return Error{flag + " names more than one law"};
      choice.kind = *law;
      continue;
    }
    if (choice.network.any()) return Error{flag + " names more than one network"};
    const Result<NetworkShape> shape = ParseNetwork(flag, part);
    if (!shape.ok()) return shape.error();
    choice.network = shape.value();
  }
  return choice;
}

std::string SelfForceText(SelfForceKind kind, const LearnedTerms* network) {
  if (network == nullptr || !network->shape.any()) return NameOf(kind);
  return (kind == SelfForceKind::kNone ? "" : NameOf(kind) + ",") + NetworkName(network->shape);
}

Result<RodShape> ParseRod(const std::string& flag, const std::string& text) {
  if (text == "constant") return RodShape{};
  const size_t colon = text.find(':');
  RodShape shape{FromName<RodKind>(text.substr(0, colon)).value_or(RodKind::kConstant)};
  shape.hidden = HiddenSizes(colon == std::string::npos ? kLdpRod : text.substr(colon + 1));
  if (shape.moves() && !shape.hidden.empty()) return shape;
  return Error{flag + " is '" + text + "'; it must be constant or, as LDP's, ldp:128-128" +
               LayersHelp()};
}

Result<InteractionChoice> ParseInteraction(const std::string& flag, const std::string& text) {
  InteractionChoice choice;
  const std::vector<std::string> parts = SplitList(text);
  for (const std::string& part : parts) {
    bool known = part == "none";
    if (known && parts.size() > 1) {
      return Error{flag + ": none stands alone; leave it or the others out"};
    }
    const size_t colon = std::min(part.find(':'), part.size());
    const std::string name = part.substr(0, colon);
    const bool ldp = name == "ldp_network";
    if (ldp || name == "network") {
      if (choice.pair.any()) return Error{flag + " names more than one network"};
      choice.pair = {HiddenSizes(part.substr(std::min(colon + 1, part.size()))), ldp};
      if (choice.pair.any()) continue;
      return Error{flag + " names '" + part +
                   "'; a network is network:4 or, as LDP's, ldp_network:512-512" + LayersHelp()};
    }
    for (const InteractionTermName& term : kInteractionTerms) {
      const bool contact = term.name == "spring" || term.name == "damping";
      if (part != term.name && !(contact && part == "contact")) continue;
      bool& named = choice.terms.*term.member;
      if (named) return Error{flag + " names '" + part + "' twice (contact is spring,damping)"};
      known = named = true;
    }
    if (known) continue;
    std::string terms = "contact (spring,damping)";
    for (const InteractionTermName& term : kInteractionTerms)
      terms += ", " + std::string(term.name);
    return Error{flag + " names '" + part + "'; it must be none, or some of " + terms};
  }
  choice.terms.learned = choice.pair.any();
  choice.terms.learned_in_range = choice.pair.ldp;
  return choice;
}

std::string InteractionText(const ModelOptions& options) {
  std::vector<std::string> names;
  for (const InteractionTermName& term : kInteractionTerms) {
    if (options.interaction.*term.member) names.emplace_back(term.name);
  }
  if (options.interaction.learned && options.learned != nullptr) {
    names.push_back(PairName(options.learned->pair));
  }
  return names.empty() ? "none" : Joined(names, ",");
}

std::string LearnedName(const LearnedTerms& learned) {
  std::vector<std::string> names;
  if (learned.shape.any()) names.push_back(NetworkName(learned.shape));
  if (learned.rod.moves()) names.push_back("rod " + RodName(learned.rod));
  if (learned.pair.any()) names.push_back("interaction " + PairName(learned.pair));
  return Joined(names, " and ");
}

std::vector<double> InitialWeights(const NetworkShape& shape, uint64_t seed) {
  Random random(seed);
  std::vector<double> weights(shape.num_weights(), 0.0);
  const auto fill = [&](int first, int last, int fan_in) {
    for (int i = first; i < last; ++i) weights[i] = random.Normal() / std::sqrt(fan_in);
  };
  fill(0, shape.gates_at(), shape.embed_width());
  fill(shape.gates_at(), shape.output_at(), shape.gate_width());
  for (int row = shape.cells(); row < 2 * shape.cells(); ++row) {
    weights[shape.gates_at() + (row + 1) * shape.gate_width() - 1] += kOpenForgetGate;
  }
  return weights;
}

std::shared_ptr<const LearnedTerms> InitialNetwork(const NetworkShape& shape, uint64_t seed,
                                                   const RodShape& rod, const PairShape& pair) {
  LearnedTerms network{shape, InitialWeights(shape, seed), rod, pair};
  AddHiddenWeights(rod.hidden, RodShape::kInputs, seed + kRodSeed, &network.weights);
  network.weights.resize(network.pair_at(), 0.0);
  AddHiddenWeights(pair.hidden, PairShape::kInputs, seed + kPairSeed, &network.weights);
  network.weights.resize(network.num_weights(), 0.0);
  return std::make_shared<const LearnedTerms>(std::move(network));
}

PUSHID_FIELDS_OF(RodShape, kind, hidden)

PUSHID_FIELDS_OF(PairShape, hidden, ldp)

inline void Fields(JsonArchive& a, LearnedTerms& network) {
  PUSHID_FIELDS(a, network.shape, kind, hidden, embedding);
  PUSHID_FIELDS(a, network, rod, weights);
  if (a.Has("interaction", network.pair.any())) a("interaction", network.pair);
}

Json ToJson(const LearnedTerms& network) { return JsonOf(network); }

std::shared_ptr<const LearnedTerms> LearnedFromJson(const Json& json) {
  const auto network = std::make_shared<const LearnedTerms>(FromJson<LearnedTerms>(json));
  if (!network->any()) throw std::runtime_error("network: nothing is learned");
  const Result<RodShape> rod = ParseRod("rod", RodName(network->rod));
  if (!rod.ok()) throw std::runtime_error(rod.error().message);
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

bool FitOptions::IsValid(std::string* error) const {
  for (const FitOptionRow& row : AllOptionRows()) {
    const std::string violated = row.violation ? row.violation(*this) : "";
    if (violated.empty()) continue;
    *error = (row.is_flag ? "--" : "") + row.name + " is " + row.text(*this) + "; it " + violated;
    return false;
  }
  *error = MissingNetwork(*this);
  if (error->empty()) *error = StanceViolation(*this);
  if (error->empty() && table.Free().empty()) {
    *error = "every parameter is fixed: nothing is left to fit";
  }
  return error->empty();
}

bool IsLarge(const FitOptions& options) {
  const auto& network = options.model.learned;
  return network != nullptr && static_cast<int>(network->weights.size()) > kMostGaussNewtonWeights;
}

PUSHID_FIELDS_OF(Prior, mean, sigma)

namespace {

// One row of the table, which names other rows.
void RowFields(JsonArchive& a, ParameterSpec& spec, const ParameterTable& table) {
  const auto find = [&table](const std::string& name, const std::string& otherwise) {
    const ParameterSpec* found = table.Find(name);
    if (found == nullptr) throw std::runtime_error(otherwise);
    return found->id;
  };
  PUSHID_FIELDS(a, spec, name, unit, nominal);
  a.Pair("bounds", spec.lower, spec.upper);
  PUSHID_FIELDS(a, spec, scale, transform, free, pooled, meaning);
  a.Optional("prior", spec.prior);
  if (a.Has("tied_to", spec.tied_to.has_value())) {
    a.Via(
        "tied_to", [&] { return table[*spec.tied_to].name; },
        [&](const std::string& to) {
          spec.tied_to = find(to, spec.name + " is tied to an unknown parameter");
        });
  }
  if (a.Has("slope_of", spec.slope_of.has_value())) {
    ParameterSpec::SlopeOf& slope = spec.slope_of ? *spec.slope_of : spec.slope_of.emplace();
    Covariate& covariate = slope.covariate;
    a.Group("slope_of", [&](auto& g) {
      g.Via(
          "parameter", [&] { return table[slope.target].name; },
          [&](const std::string& of) {
            slope.target = find(of, "a slope of an unknown parameter");
          });
      g("covariate", covariate.key);
      if (g.Has("values", covariate.is_contrast())) {
        g.Pair("values", covariate.first, covariate.second);
      } else {
        g("centre", covariate.centre);
      }
    });
  }
  if (a.Has("pooling_sigma", spec.pooled)) a("pooling_sigma", spec.pooling_sigma);
}

}  // namespace

Json TableJson(const ParameterTable& table) {
  Json rows = Json::array();
  for (ParameterSpec spec : table.specs) {
    JsonArchive archive(&rows.emplace_back(Json::object()));
    RowFields(archive, spec, table);
  }
  return rows;
}

Json OptionsJson(const FitOptions& options) {
  Json json;
  for (const FitOptionRow& row : AllOptionRows()) {
    if (!row.json.empty()) json[Json::json_pointer(row.json)] = row.write(options);
  }
  return json;
}

ParameterTable TableFrom(const Json& json, const ParameterTable& known) {
  ParameterTable table = known;
  for (const Json& row : json) {
    const std::string name = row.at("name");
    ParameterSpec* spec = table.Find(name);
    if (spec == nullptr && row.contains("slope_of")) {
      if (table.specs.size() >= static_cast<size_t>(kNumParameters)) {
        throw std::runtime_error("there is no room for '" + name + "'");
      }
      ParameterFacts facts;
      facts.name = name;
      spec = &table.Add(facts);
    }
    if (spec == nullptr) throw std::runtime_error("unknown parameter '" + name + "'");
    spec->pooling_sigma = kFirstPoolingSigma;
    spec->tied_to.reset();
    spec->prior.reset();
    JsonArchive archive(row);
    RowFields(archive, *spec, table);
  }
  return table;
}

FitOptions OptionsFrom(const Json& json) {
  FitOptions options;
  for (const FitOptionRow& row : AllOptionRows()) {
    if (!row.json.empty()) row.read(json.at(Json::json_pointer(row.json)), &options);
  }
  return options;
}

}  // namespace pushid
