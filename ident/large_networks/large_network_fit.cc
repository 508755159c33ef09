// ident: L-BFGS and Adam over the weights of a large network.
#include "ident/large_networks/large_network_fit.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "datasets/files/random.h"
#include "ident/large_networks/network_judge.h"
#include "ident/parameters/learned_terms_io.h"

namespace pushid {
namespace {

class TrainingCost : public ceres::FirstOrderFunction {
 public:
  TrainingCost(const LargeNetworkFit& fit, AdjointGradient* adjoint)
      : variables_(fit), adjoint_(adjoint), by_shared_(fit.shared.size()) {}

  int NumParameters() const override { return variables_.size(); }
  int gradients() const { return gradients_; }

  // False, so that the line search takes a shorter step, where a recording leaves the domain.
  bool Evaluate(const double* x, double* cost, double* gradient) const override {
    const std::vector<double>& shared = variables_.Shared(x);
    const AdjointCost data = adjoint_->Evaluate(
        shared.data(), x, gradient != nullptr ? by_shared_.data() : nullptr, gradient);
    if (!data.ok()) return false;
    gradients_ += gradient != nullptr ? 1 : 0;
    if (gradient != nullptr) variables_.Scale(by_shared_, gradient);
    *cost = data.cost + variables_.AddPriors(x, gradient);
    return std::isfinite(*cost);
  }

 private:
  // Ceres' const means that the function stays the same, not that it keeps no memory.
  mutable NetworkVariables variables_;
  AdjointGradient* adjoint_;
  mutable std::vector<double> by_shared_;
  mutable int gradients_ = 0;
};

MaybeError CheckFit(const LargeNetworkFit& fit) {
  if (fit.model.learned == nullptr) return Error{"there is no network to train"};
  const LearnedTerms& network = *fit.model.learned;
  if (static_cast<int>(network.weights.size()) != network.num_weights()) {
    return Error{"the network " + LearnedName(network) + " has " +
                 std::to_string(network.num_weights()) + " weights, but " +
                 std::to_string(network.weights.size()) + " are given to start from"};
  }
  if (fit.training.empty()) return Error{"there are no recordings to train the network on"};
  const auto fitted = static_cast<size_t>(fit.map.num_shared());
  if (fit.shared.size() != fitted ||
      (fit.options.fit_shared && fit.shared_prior.size() != fitted)) {
    return Error{"one value (and, where they are fitted, one prior) is needed for each of " +
                 std::to_string(fitted) + " shared parameters"};
  }
  return std::nullopt;
}

// The training recordings, those that fail at the start held to the frames before.
std::vector<AdjointRecording> Shortened(const LargeNetworkFit& fit,
                                        const std::vector<ShortenedRecording>& shortened) {
  std::vector<AdjointRecording> recordings = fit.training;
  for (const ShortenedRecording& one : shortened) {
    recordings[one.training].horizon = one.status.frame;
  }
  return recordings;
}

Result<AdjointGradient> MakeTraining(const LargeNetworkFit& fit,
                                     std::vector<ShortenedRecording>* shortened) {
  Result<AdjointGradient> whole =
      AdjointGradient::Create(fit.training, fit.model, fit.map, fit.sigmas);
  if (!whole.ok()) return whole;
  const AdjointCost start = whole.value().Evaluate(
      fit.shared.data(), fit.model.learned->weights.data(), nullptr, nullptr);
  if (start.ok()) return whole;
  for (int i = 0; i < static_cast<int>(fit.training.size()); ++i) {
    if (!start.status[i].ok) shortened->push_back({i, start.status[i]});
  }
  return AdjointGradient::Create(Shortened(fit, *shortened), fit.model, fit.map, fit.sigmas);
}

ceres::GradientProblemSolver::Options LbfgsOptions(const LargeNetworkOptions& options) {
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::LBFGS;
  solver.line_search_type = ceres::WOLFE;
  solver.max_lbfgs_rank = options.memory;
  // Weights are all of one kind, and one factor for all of them saves most of the line searches.
  solver.use_approximate_eigenvalue_bfgs_scaling = true;
  solver.max_num_iterations = options.max_iterations;
  solver.max_solver_time_in_seconds = options.max_seconds;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  solver.update_state_every_iteration = true;  // for the judge
  return solver;
}

void SolveByLbfgs(const LargeNetworkFit& fit, AdjointGradient* training, NetworkJudge* judge,
                  std::vector<double>* x, LargeNetworkSolution* solution) {
  auto* cost = new TrainingCost(fit, training);
  const ceres::GradientProblem problem(cost);  // takes ownership
  ceres::GradientProblemSolver::Options options = LbfgsOptions(fit.options);
  options.callbacks.push_back(judge);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, x->data(), &summary);
  solution->message = summary.message;
  solution->converged = summary.termination_type == ceres::CONVERGENCE;
  solution->gradients = cost->gradients();
}

// Adam (Kingma and Ba, 2015) with its usual constants.
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

// A gradient that is far longer than those before tells of somebody who is about to fall, and
// little of where to go.
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

// The training recordings at random, kRecordingsOfAStep at a time. Where a rollout leaves the
// domain, the frames before count.
class TrainingBatches {
 public:
  static Result<TrainingBatches> Create(const LargeNetworkFit& fit,
                                        std::vector<AdjointRecording> recordings) {
    constexpr size_t kRecordingsOfAStep = 8;
    TrainingBatches made(fit);
    made.random_.Shuffle(&recordings);
    for (size_t i = 0; i < recordings.size(); i += kRecordingsOfAStep) {
      const auto end = recordings.begin() + std::min(i + kRecordingsOfAStep, recordings.size());
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

// Passes over all batches; the rate falls to a hundredth of its start.
MaybeError SolveByAdam(const LargeNetworkFit& fit, const std::vector<ShortenedRecording>& shortened,
                       NetworkJudge* judge, std::vector<double>* x,
                       LargeNetworkSolution* solution) {
  constexpr double kLastRate = 0.01;
  Result<TrainingBatches> batches = TrainingBatches::Create(fit, Shortened(fit, shortened));
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
    if ((*judge)(summary) != ceres::SOLVER_CONTINUE) break;
  }
  solution->message = "all passes done";
  return std::nullopt;
}

}  // namespace

std::vector<SharedPrior> SharedPriors(const ParameterTable& table, const ParameterMap& map) {
  std::vector<SharedPrior> priors;
  for (const FittedParameter& f : map.fitted) {
    const ParameterSpec& spec = table[f.parameter];
    SharedPrior prior;
    prior.unit = f.transform == Transform::kIdentity ? spec.scale : 1.0;
    if (spec.prior) {
      prior.mean = ToFitted(f.transform, spec.prior->mean);
      prior.sigma = spec.prior->sigma / TransformSlope(f.transform, spec.prior->mean);
    }
    priors.push_back(prior);
  }
  return priors;
}

std::shared_ptr<const LearnedTerms> LargeNetworkSolution::Network(LearnedTerms like) const {
  like.weights = weights;
  return std::make_shared<const LearnedTerms>(std::move(like));
}

Result<LargeNetworkSolution> FitLargeNetwork(const LargeNetworkFit& fit,
                                             const LargeNetworkProgress& progress) {
  if (const MaybeError error = CheckFit(fit)) return *error;
  LargeNetworkSolution solution;
  Result<AdjointGradient> training = MakeTraining(fit, &solution.shortened);
  if (!training.ok()) return training.error();
  Result<AdjointGradient> held_out =
      AdjointGradient::Create(fit.held_out, fit.model, fit.map, fit.sigmas);
  if (!held_out.ok()) return held_out.error();

  std::vector<double> x = NetworkVariables(fit).Start();
  NetworkJudge judge(fit, fit.held_out.empty() ? nullptr : &held_out.value(), &x, progress,
                     &solution);
  if (fit.options.optimizer == NetworkOptimizer::kAdam) {
    if (MaybeError error = SolveByAdam(fit, solution.shortened, &judge, &x, &solution)) {
      return *error;
    }
  } else {
    SolveByLbfgs(fit, &training.value(), &judge, &x, &solution);
  }
  if (solution.trace.empty()) {
    return Error{"the training of the network could not start: " + solution.message};
  }
  solution.best_iteration = judge.Best().iteration;
  solution.final_cost = judge.Best().cost;
  solution.final_training_cost = judge.Best().training_cost;
  solution.best_held_out_cost = judge.Best().held_out_cost;
  solution.held_out_failures = judge.Best().held_out_failures;
  solution.seconds = solution.trace.back().seconds;
  return solution;
}

}  // namespace pushid
