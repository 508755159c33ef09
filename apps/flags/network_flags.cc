// apps: learned self forces and rods by flag.
#include "apps/flags/network_flags.h"

#include <gflags/gflags.h>

#include <memory>
#include <string>

#include "ident/parameters/self_network_io.h"
#include "ident/solver/large_network_stage.h"

DEFINE_string(self_force, "",
              "what is fitted on top: none, linear (cross terms, quadratic), a network by kind and "
              "hidden size (mlp:4, gru:4, lstm:4; lstm:256:32 with an embedding), or linear and a "
              "network, comma-separated (default: the preset's)");
DEFINE_string(rod, "constant",
              "the rod's length: constant, or a state that a learned law changes, together with "
              "the cart's height: linear, mlp:4, mlp:256-128-256 (hidden sizes)");
DEFINE_bool(rod_input, false, "let the self force's network see how far the rod has moved");
DEFINE_double(network_prior, 1.0,
              "standard deviation of the prior that ties a network's weights to zero; 0: none");
DEFINE_double(early_stopping, 0.0,
              "share of the recordings held out to stop a network's training in time; 0: none");
DEFINE_double(takeover_weight, 0.0,
              "weight of the penalty on what a network takes over from friction and balance");
DEFINE_int32(ensemble, 1,
             "networks trained from so many seeds; the model predicts the median of them");

namespace pushid {
namespace {

bool IsDefault(const char* flag) { return gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

}  // namespace

MaybeError ReadNetworkFlags(uint64_t seed, FitOptions* o) {
  NetworkShape self;
  if (!FLAGS_self_force.empty()) {
    const Result<SelfForceChoice> choice = ParseSelfForce("--self_force", FLAGS_self_force);
    if (!choice.ok()) return choice.error();
    o->self_force = choice.value().kind;
    self = choice.value().network;
  }
  const Result<RodShape> rod = ParseRod("--rod", FLAGS_rod);
  if (!rod.ok()) return rod.error();
  if (FLAGS_rod_input && !(self.any() && rod.value().moves())) {
    return Error{
        "--rod_input is for a network beside a rod that moves, as in --self_force=mlp:4 "
        "--rod=linear"};
  }
  self.rod_input = FLAGS_rod_input;
  if (self.any() || rod.value().moves()) {
    o->model.self_network = InitialNetwork(self, seed, rod.value());
  }
  o->network_prior = FLAGS_network_prior;
  o->early_stopping = FLAGS_early_stopping;
  o->takeover_weight = FLAGS_takeover_weight;
  o->ensemble = FLAGS_ensemble;
  return std::nullopt;
}

MaybeError CheckNetworkFlags(const FitOptions& o) {
  const auto& network = o.model.self_network;
  for (const char* flag : {"network_prior", "early_stopping", "takeover_weight", "ensemble"}) {
    if (network != nullptr || IsDefault(flag)) continue;
    return Error{std::string("--") + flag +
                 " acts on networks, but there is none; add one, as in --self_force=mlp:4"};
  }
  if (network == nullptr) return std::nullopt;
  if (!network->shape.any() && !IsDefault("takeover_weight")) {
    return Error{"--takeover_weight acts on a network's force, but only the rod has a network"};
  }
  const bool large = NeedsGradientTraining(o);
  if (large && !IsDefault("takeover_weight")) {
    return Error{"--takeover_weight is for small networks; this one is trained by its gradient"};
  }
  if (o.ensemble > 1 && large) {
    return Error{"--ensemble is for small networks; this one is trained by its gradient"};
  }
  if (large && (o.model.interaction.Any() || AnyPooled(o.table))) {
    return Error{LearnedName(*network) +
                 " is trained by its gradient, which knows no people who touch and no pooled "
                 "parameters; choose a smaller network, or --interaction=none --pool=none"};
  }
  if (o.ensemble > 1 && AnyPooled(o.table)) {
    return Error{"--ensemble does not go together with --pool: its members share all parameters"};
  }
  return std::nullopt;
}

}  // namespace pushid
