// ident: rows of the options that say how networks are trained.
#include "ident/parameters/option_row_makers.h"

namespace pushid {

std::vector<FitOptionRow> NetworkOptionRows() {
  using O = FitOptions;
  return {
      MayBeAbsent(Decided(NameRow<NetworkTraining>(
          "network_training", "/network_training",
          [](O & o) -> auto& { return o.network_training; },
          "large networks: after_physics (fitted without them first, and again with them held), or "
          "together with the free parameters"))),
      MayBeAbsent(Decided(NameRow<NetworkOptimizer>(
          "network_optimizer", "/network_optimizer",
          [](O & o) -> auto& { return o.network_optimizer; },
          "large networks: lbfgs (Ceres' L-BFGS on all recordings) or adam (on eight at a time)"))),
      MayBeAbsent(CountRow(
          "network_iterations", "/network_iterations",
          [](O & o) -> auto& { return o.network_iterations; },
          "large networks: iterations of L-BFGS or passes of Adam, at most")),
      MayBeAbsent(NumberRow(
          "network_rate", "/network_rate", [](O & o) -> auto& { return o.network_rate; }, kPositive,
          "large networks: Adam's learning rate, which falls to a hundredth of it")),
      MayBeAbsent(NumberRow(
          "network_prior", "/network_prior", [](O & o) -> auto& { return o.network_prior; },
          kNotNegative,
          "standard deviation of the prior that ties a network's weights to zero; 0: none")),
      MayBeAbsent(NumberRow(
          "early_stopping", "/early_stopping", [](O & o) -> auto& { return o.early_stopping; },
          {0.0, 0.5, false, "must lie between 0 and 0.5"},
          "share of the recordings held out for early stopping of a network's training; 0: none")),
      MayBeAbsent(CountRow(
          "ensemble", "/ensemble", [](O & o) -> auto& { return o.ensemble; },
          "number of networks, trained from different seeds; the model predicts their median")),
  };
}

}  // namespace pushid
