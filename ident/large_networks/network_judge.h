// ident: what the training of a large network moves and judges (large_network_fit.h).
#pragma once

#include <ceres/iteration_callback.h>

#include <chrono>
#include <vector>

#include "ident/large_networks/large_network_fit.h"

namespace pushid {

// From the flat vector that is moved, [weights, (shared - start) / unit], to a point.
class NetworkVariables {
 public:
  explicit NetworkVariables(const LargeNetworkFit& fit);

  int size() const { return num_weights_ + num_shared(); }
  int num_weights() const { return num_weights_; }
  int num_shared() const {
    return fit_.options.fit_shared ? static_cast<int>(fit_.shared.size()) : 0;
  }
  std::vector<double> Start() const;
  const std::vector<double>& Shared(const double* variables);

  // Returns the cost of the priors at Shared(variables), and adds their gradient (may be null).
  double AddPriors(const double* variables, double* gradient) const;
  // From d/d(shared) to d/d(variables).
  void Scale(const std::vector<double>& by_shared, double* gradient) const;

 private:
  const LargeNetworkFit& fit_;
  int num_weights_;
  std::vector<double> shared_;
};

// The training recordings, those of `shortened` held to the frames before their failure.
std::vector<AdjointRecording> Shortened(const LargeNetworkFit& fit,
                                        const std::vector<ShortenedRecording>& shortened);

// Judges what is held out, and keeps the best point: the latest where nothing is.
class NetworkJudge : public ceres::IterationCallback {
 public:
  // held_out: null where nothing is; x: what is moved.
  NetworkJudge(const LargeNetworkFit& fit, AdjointGradient* held_out, const std::vector<double>* x,
               const LargeNetworkProgress& progress, LargeNetworkSolution* solution);

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override;

  const LargeNetworkIteration& Best() const { return solution_.trace[best_]; }

 private:
  LargeNetworkIteration Now(const ceres::IterationSummary& summary);

  using Clock = std::chrono::steady_clock;
  const LargeNetworkFit& fit_;
  NetworkVariables variables_;
  AdjointGradient* held_out_;
  const std::vector<double>& x_;
  const LargeNetworkProgress& progress_;
  LargeNetworkSolution& solution_;
  size_t best_ = 0;  // in the trace
  Clock::time_point begin_ = Clock::now();
};

inline constexpr int kRecordingsOfAStep = 8;

// Adam (Kingma and Ba, 2015) with its usual constants, on kRecordingsOfAStep recordings at a time,
// dealt out once and taken in random order: fit.options.max_iterations passes over all of them.
// The rate falls to a hundredth of fit.options.rate. A gradient more than twice as
// long as those before on average is shortened to that: it tells of somebody who is about to fall.
// Where a rollout leaves the domain, the frames before count, and solution->training_failures
// counts it. x: moved; training: as large_network_fit.h shortens them. Errors: what AdjointGradient
// refuses; a cost or gradient that is not finite.
MaybeError SolveByAdam(const LargeNetworkFit& fit, const std::vector<AdjointRecording>& training,
                       NetworkJudge* judge, std::vector<double>* x, LargeNetworkSolution* solution);

}  // namespace pushid
