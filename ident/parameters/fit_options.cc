// ident: whether options can be used.
#include "ident/parameters/fit_options.h"

#include "ident/parameters/option_table.h"
#include "ident/parameters/self_network_io.h"

namespace pushid {
namespace {

// What a network cannot do together with the rest; empty: nothing.
std::string NetworkViolation(const FitOptions& o) {
  const auto& network = o.model.self_network;
  if (network == nullptr) return "";
  const bool large = NeedsGradientTraining(o), pooled = AnyPooled(o.table);
  if (large && o.takeover_weight > 0.0) {
    return "--takeover_weight is for small networks; this one is trained by its gradient";
  }
  if (o.ensemble > 1 && large) {
    return "--ensemble is for small networks; this one is trained by its gradient";
  }
  if (large && (o.model.interaction.Any() || pooled)) {
    return LearnedName(*network) +
           " is trained by its gradient, which knows no people who touch and no pooled "
           "parameters; choose a smaller network, or --interaction=none --pool=none";
  }
  if (o.ensemble > 1 && pooled) {
    return "--ensemble does not go together with --pool: its members share all parameters";
  }
  return "";
}

}  // namespace

bool FitOptions::IsValid(std::string* error) const {
  for (const FitOptionRow& row : FitOptionRows()) {
    const std::string violated = row.violation ? row.violation(*this) : "";
    if (violated.empty()) continue;
    *error = "--" + row.name + " is " + row.text(*this) + "; it " + violated;
    return false;
  }
  *error = NetworkViolation(*this);
  if (error->empty() && table.Free().empty()) {
    *error = "every parameter is fixed: nothing is left to fit";
  }
  return error->empty();
}

bool NeedsGradientTraining(const FitOptions& options) {
  const auto& network = options.model.self_network;
  return !options.hold_network && network != nullptr &&
         static_cast<int>(network->weights.size()) > kMostGaussNewtonWeights;
}

}  // namespace pushid
