// ident: training a network too large for Gauss-Newton, together with the free parameters, by its
// adjoint gradient (residuals/adjoint/adjoint_gradient.h) and Adam.
//
//   cost = cost of the training recordings + 1/2 |weights / sigma|^2
//        + 1/2 |(shared - mean) / sigma|^2
// Starts from the network that the model holds: random hidden weights and no output. The same start
// and the same seed give the same bits.
//
// Adam (Kingma and Ba, 2015) with its usual constants, as LDP trains, on kRecordingsOfAStep
// recordings at a time, dealt out once and taken in random order. A gradient more than twice as
// long as those before on average is shortened to that: it tells of somebody who is about to fall.
// Where a rollout leaves the domain, the frames before count. (L-BFGS on all recordings ends at the
// first switch of LDP's forces.) Parameters have no bounds here: keep them fixed, or hold them by
// priors on the fitted scale.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/parameters/parameter_table.h"
#include "ident/problem/fit_point.h"
#include "residuals/adjoint/adjoint_gradient.h"

namespace pushid {

inline constexpr int kRecordingsOfAStep = 8;

struct LargeNetworkOptions {
  double rate = 1e-3, last_rate = 1e-5;  // at first, and in the last pass
  int passes = 200;                      // over all recordings
  uint64_t seed = 1;                     // of their order
  double weight_sigma = 1.0;             // of the prior that ties the weights to zero; 0: none
};
// Options with the rates of what is trained: LDP's networks have 3e-4 throughout, as published.
LargeNetworkOptions OptionsFor(const LearnedTerms& learned);

// The prior of a shared parameter, on the fitted scale.
struct SharedPrior {
  double mean = 0.0;
  double sigma = std::numeric_limits<double>::infinity();
  double unit = 1.0;  // a typical change: what Adam takes for one
};
// Values of the table, one for each of the map's fitted parameters.
std::vector<SharedPrior> SharedPriors(const ParameterTable& table, const ParameterMap& map);

struct LargeNetworkFit {
  std::vector<AdjointRecording> training;
  ModelOptions model;  // with the network to start from
  ParameterMap map;
  ResidualSigmas sigmas;
  std::vector<double> shared;  // where the fitted parameters start
  std::vector<SharedPrior> shared_prior;
  LargeNetworkOptions options;
};

// A pass, whose cost is summed while the weights move; the first one does not move them.
struct LargeNetworkPass {
  int pass = 0;
  double cost = 0.0;  // all that is minimized
  int failures = 0;   // rollouts that left the domain
};

struct LargeNetworkSolution {
  std::vector<double> shared, weights;
  std::vector<LargeNetworkPass> passes;
  // Training recordings that could not be rolled out to their end at the start: held to the frames
  // before throughout.
  std::vector<FailedRollout> shortened;

  // The trained network; like: of its shape.
  std::shared_ptr<const LearnedTerms> Network(LearnedTerms like) const;
};

// Called after every pass; false ends the training.
using LargeNetworkProgress = std::function<bool(const LargeNetworkPass&)>;

// Errors: what AdjointGradient refuses, sizes that do not fit, nothing to train on, a cost or
// gradient that is not finite.
Result<LargeNetworkSolution> FitLargeNetwork(const LargeNetworkFit& fit,
                                             const LargeNetworkProgress& progress = nullptr);

}  // namespace pushid
