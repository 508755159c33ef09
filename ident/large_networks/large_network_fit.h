// ident: training a network too large for Gauss-Newton, by its adjoint gradient
// (residuals/adjoint/adjoint_gradient.h) and L-BFGS, or Adam.
//
//   cost = cost of the training recordings + 1/2 |weights / sigma|^2
//        (+ 1/2 |(shared - mean) / sigma|^2, where the shared parameters are fitted too)
//   LargeNetworkFit fit{training, held_out, options.model, options.table.Map(), options.sigmas};
//   fit.shared = ..., fit.options.weight_sigma = ...;
//   Result<LargeNetworkSolution> solution = FitLargeNetwork(fit);
// Starts from the network that the model holds: random hidden weights and no output. The same start
// (and, of Adam, the same seed) gives the same bits.
//
// Early stopping: after every iteration the held-out recordings are judged, by those that fail
// first, then by cost; the best point of all is kept. L-BFGS takes no step under which a training
// recording leaves the domain. Parameters have no bounds here: keep them fixed, or hold them by
// priors on the fitted scale. Adam (network_judge.h): the cost of a pass is summed while
// the weights move.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/parameters/parameter_table.h"
#include "residuals/adjoint/adjoint_gradient.h"

namespace pushid {

struct LargeNetworkOptions {
  NetworkOptimizer optimizer = NetworkOptimizer::kLbfgs;
  double rate = 1e-3;         // of Adam, at first
  uint64_t seed = 1;          // of Adam's order
  double weight_sigma = 1.0;  // of the prior that ties the weights to zero; 0: none
  bool fit_shared = false;    // the map's fitted parameters too, not only the weights
  int max_iterations = 500;
  int patience = 30;                 // iterations without a better held-out cost
  int memory = 20;                   // steps that L-BFGS remembers
  double function_tolerance = 1e-7;  // relative change of the cost that ends it
};

// What holds a shared parameter, on the fitted scale.
struct SharedPrior {
  double mean = 0.0;
  double sigma = std::numeric_limits<double>::infinity();
  double unit = 1.0;  // a typical change: what L-BFGS takes for one
};
// As the table says, one for each of the map's fitted parameters.
std::vector<SharedPrior> SharedPriors(const ParameterTable& table, const ParameterMap& map);

struct LargeNetworkFit {
  std::vector<AdjointRecording> training, held_out;  // none held out: on until it converges
  ModelOptions model;                                // with the network to start from
  ParameterMap map;
  ResidualSigmas sigmas;
  std::vector<double> shared;             // where the fitted parameters start or stay
  std::vector<SharedPrior> shared_prior;  // needed where they are fitted
  LargeNetworkOptions options;
};

struct LargeNetworkIteration {
  int iteration = 0;
  double cost = 0.0;           // all that is minimized
  double training_cost = 0.0;  // of the training recordings alone
  double held_out_cost = 0.0;  // of the held-out recordings alone
  int held_out_failures = 0;
  int training_failures = 0;  // of Adam, whose steps may make rollouts leave the domain
  double gradient = 0.0;      // largest component
  double seconds = 0.0;       // since the start
};

// A training recording that could not be rolled out to its end at the start: held to the frames
// before throughout.
struct ShortenedRecording {
  int training = 0;  // its index
  RolloutStatus status;
};

struct LargeNetworkSolution {
  std::vector<double> shared, weights;  // the best point
  int best_iteration = 0;
  double initial_cost = 0.0, final_cost = 0.0;  // of what is minimized; final: of the best point
  double initial_training_cost = 0.0, final_training_cost = 0.0;  // without the priors
  double initial_held_out_cost = 0.0, best_held_out_cost = 0.0;
  int held_out_failures = 0;  // at the best point
  int training_failures = 0;  // in the last pass of Adam
  bool stopped_early = false;
  bool converged = false;  // by tolerance
  std::string message;     // why it ended
  int gradients = 0;       // evaluations
  double seconds = 0.0;
  std::vector<ShortenedRecording> shortened;
  std::vector<LargeNetworkIteration> trace;  // from iteration 0 on

  // The network at the best point; like: of its shape.
  std::shared_ptr<const LearnedTerms> Network(LearnedTerms like) const;
};

// Called after every iteration; false ends the training.
using LargeNetworkProgress = std::function<bool(const LargeNetworkIteration&)>;

// Errors: what AdjointGradient refuses, sizes that do not fit, nothing to train on.
Result<LargeNetworkSolution> FitLargeNetwork(const LargeNetworkFit& fit,
                                             const LargeNetworkProgress& progress = nullptr);

}  // namespace pushid
