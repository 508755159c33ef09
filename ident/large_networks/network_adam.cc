// ident: passes of Adam.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "datasets/files/random.h"
#include "ident/large_networks/network_judge.h"

namespace pushid {
namespace {

class Adam {
 public:
  explicit Adam(Eigen::Index size)
      : mean_(Eigen::ArrayXd::Zero(size)), square_(Eigen::ArrayXd::Zero(size)) {}

  void Step(const Eigen::ArrayXd& gradient, double rate, std::vector<double>* x) {
    constexpr double kMean = 0.9, kSquare = 0.999, kTiny = 1e-8;
    mean_ = kMean * mean_ + (1.0 - kMean) * gradient;
    square_ = kSquare * square_ + (1.0 - kSquare) * gradient.square();
    of_mean_ *= kMean, of_square_ *= kSquare;
    const Eigen::ArrayXd scale = (square_ / (1.0 - of_square_)).sqrt() + kTiny;
    Eigen::Map<Eigen::ArrayXd>(x->data(), mean_.size()) -= rate / (1.0 - of_mean_) * mean_ / scale;
  }

 private:
  Eigen::ArrayXd mean_, square_;
  double of_mean_ = 1.0, of_square_ = 1.0;
};

class Clip {
 public:
  void Shorten(Eigen::ArrayXd* gradient) {
    constexpr double kLongest = 2.0, kKept = 0.95;  // of the mean length so far
    const double length = gradient->matrix().norm();
    const double most = mean_ > 0.0 ? std::min(length, kLongest * mean_) : length;
    if (most < length) *gradient *= most / length;
    mean_ = mean_ > 0.0 ? kKept * mean_ + (1.0 - kKept) * most : length;
  }

 private:
  double mean_ = 0.0;
};

class TrainingBatches {
 public:
  static Result<TrainingBatches> Create(const LargeNetworkFit& fit,
                                        std::vector<AdjointRecording> recordings) {
    TrainingBatches made(fit);
    made.random_.Shuffle(&recordings);
    for (size_t i = 0; i < recordings.size(); i += kRecordingsOfAStep) {
      const auto end =
          recordings.begin() + std::min(i + size_t{kRecordingsOfAStep}, recordings.size());
      Result<AdjointGradient> batch =
          AdjointGradient::Create({recordings.begin() + i, end}, fit.model, fit.map, fit.sigmas);
      if (!batch.ok()) return batch.error();
      made.batches_.push_back(std::move(batch.value()));
    }
    return made;
  }

  // Calls step(gradient) for each, in random order; returns the sum of their costs and failures.
  template <typename Step>
  std::pair<double, int> Pass(const std::vector<double>& x, const Step& step) {
    std::pair<double, int> sum = {0.0, 0};
    std::vector<int> order(batches_.size());
    std::iota(order.begin(), order.end(), 0);
    random_.Shuffle(&order);
    const double share = 1.0 / static_cast<double>(batches_.size());
    for (int k : order) {
      const double* shared = variables_.Shared(x.data()).data();
      gradient_.setZero();
      const AdjointCost cost =
          batches_[k].Evaluate(shared, x.data(), by_shared_.data(), gradient_.data());
      variables_.Scale(by_shared_, gradient_.data());
      of_priors_.setZero();
      sum.first += cost.cost + share * variables_.AddPriors(x.data(), of_priors_.data());
      sum.second += cost.num_failed();
      gradient_ += share * of_priors_;
      step(&gradient_);
    }
    return sum;
  }

 private:
  explicit TrainingBatches(const LargeNetworkFit& fit)
      : variables_(fit),
        random_(fit.options.seed),
        gradient_(variables_.size()),
        of_priors_(variables_.size()),
        by_shared_(fit.shared.size()) {}

  NetworkVariables variables_;
  Random random_;
  std::vector<AdjointGradient> batches_;
  Eigen::ArrayXd gradient_, of_priors_;
  std::vector<double> by_shared_;
};

}  // namespace

MaybeError SolveByAdam(const LargeNetworkFit& fit, const std::vector<AdjointRecording>& training,
                       NetworkJudge* judge, std::vector<double>* x,
                       LargeNetworkSolution* solution) {
  constexpr double kLastRate = 0.01;
  Result<TrainingBatches> batches = TrainingBatches::Create(fit, training);
  if (!batches.ok()) return batches.error();
  Adam adam(static_cast<Eigen::Index>(x->size()));
  Clip clip;
  const int passes = fit.options.max_iterations;
  for (int pass = 0; pass <= passes; ++pass) {
    const double rate =
        pass == 0 ? 0.0 : fit.options.rate * std::pow(kLastRate, double(pass) / passes);
    ceres::IterationSummary summary;
    summary.iteration = pass;
    summary.step_is_successful = true;
    std::tie(summary.cost,
             solution->training_failures) = batches.value().Pass(*x, [&](Eigen::ArrayXd* gradient) {
      ++solution->gradients;
      summary.gradient_max_norm = std::max(summary.gradient_max_norm, gradient->abs().maxCoeff());
      clip.Shorten(gradient);
      if (rate > 0.0) adam.Step(*gradient, rate, x);
    });
    if (!std::isfinite(summary.cost) || !std::isfinite(summary.gradient_max_norm)) {
      return Error{"Adam's pass " + std::to_string(pass) +
                   " has a cost or a gradient that is not finite; lower --network_rate"};
    }
    const bool goes_on = (*judge)(summary) == ceres::SOLVER_CONTINUE;
    solution->message = goes_on ? "all passes done" : "ended early";
    if (!goes_on) break;
  }
  return std::nullopt;
}

}  // namespace pushid
