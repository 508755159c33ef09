// ident: L-BFGS over the weights of a large network.
#include "ident/large_networks/large_network_fit.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "ident/parameters/learned_terms_io.h"

namespace pushid {
namespace {

using Clock = std::chrono::steady_clock;

// From the flat vector that L-BFGS moves, [weights, (shared - start) / unit], to a point.
class Variables {
 public:
  explicit Variables(const LargeNetworkFit& fit)
      : fit_(fit), num_weights_(fit.model.learned->num_weights()), shared_(fit.shared) {}

  int size() const { return num_weights_ + num_shared(); }
  int num_weights() const { return num_weights_; }
  int num_shared() const {
    return fit_.options.fit_shared ? static_cast<int>(fit_.shared.size()) : 0;
  }
  std::vector<double> Start() const {
    std::vector<double> start = fit_.model.learned->weights;
    start.resize(size(), 0.0);
    return start;
  }
  const std::vector<double>& Shared(const double* variables) {
    for (int i = 0; i < num_shared(); ++i) {
      shared_[i] = fit_.shared[i] + fit_.shared_prior[i].unit * variables[num_weights_ + i];
    }
    return shared_;
  }

  // Returns the cost of the priors at Shared(variables), and adds their gradient (may be null).
  double AddPriors(const double* variables, double* gradient) const {
    double cost = 0.0;
    const double sigma = fit_.options.weight_sigma;
    if (sigma > 0.0) {
      const Eigen::Map<const Eigen::VectorXd> weights(variables, num_weights_);
      cost += 0.5 * weights.squaredNorm() / (sigma * sigma);
      if (gradient != nullptr) {
        Eigen::Map<Eigen::VectorXd>(gradient, num_weights_) += weights / (sigma * sigma);
      }
    }
    for (int i = 0; i < num_shared(); ++i) {
      const SharedPrior& prior = fit_.shared_prior[i];
      const double r = (shared_[i] - prior.mean) / prior.sigma;
      cost += 0.5 * r * r;
      if (gradient != nullptr) gradient[num_weights_ + i] += r / prior.sigma * prior.unit;
    }
    return cost;
  }

  // From d/d(shared) to d/d(variables).
  void Scale(const std::vector<double>& by_shared, double* gradient) const {
    for (int i = 0; i < num_shared(); ++i) {
      gradient[num_weights_ + i] = by_shared[i] * fit_.shared_prior[i].unit;
    }
  }

 private:
  const LargeNetworkFit& fit_;
  int num_weights_;
  std::vector<double> shared_;
};

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
  mutable Variables variables_;
  AdjointGradient* adjoint_;
  mutable std::vector<double> by_shared_;
  mutable int gradients_ = 0;
};

// Judges what is held out, and keeps the best point.
class Judge : public ceres::IterationCallback {
 public:
  Judge(const LargeNetworkFit& fit, AdjointGradient* held_out, const std::vector<double>* x,
        const LargeNetworkProgress& progress, LargeNetworkSolution* solution)
      : fit_(fit),
        variables_(fit),
        held_out_(held_out),
        x_(*x),
        progress_(progress),
        solution_(*solution),
        begin_(Clock::now()) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (!solution_.trace.empty() && !summary.step_is_successful) return ceres::SOLVER_CONTINUE;
    LargeNetworkIteration now;
    now.iteration = summary.iteration;
    now.cost = summary.cost;
    now.gradient = summary.gradient_max_norm;
    const std::vector<double>& shared = variables_.Shared(x_.data());
    now.training_cost = now.cost - variables_.AddPriors(x_.data(), nullptr);
    if (held_out_ != nullptr) {
      const AdjointCost judged = held_out_->Evaluate(shared.data(), x_.data(), nullptr, nullptr);
      now.held_out_cost = judged.cost;
      now.held_out_failures =
          static_cast<int>(std::count_if(judged.status.begin(), judged.status.end(),
                                         [](const RolloutStatus& status) { return !status.ok; }));
    }
    now.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    const bool first = solution_.trace.empty();
    solution_.trace.push_back(now);
    if (first) {
      solution_.initial_cost = now.cost;
      solution_.initial_training_cost = now.training_cost;
      solution_.initial_held_out_cost = now.held_out_cost;
    }
    const LargeNetworkIteration& best = solution_.trace[best_];
    // Where nothing is held out, the latest is the best: the cost never rises.
    if (first || held_out_ == nullptr ||
        std::pair(now.held_out_failures, now.held_out_cost) <
            std::pair(best.held_out_failures, best.held_out_cost)) {
      best_ = solution_.trace.size() - 1;
      solution_.weights.assign(x_.begin(), x_.begin() + variables_.num_weights());
      solution_.shared = shared;
    }
    if (progress_ && !progress_(now)) return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    const size_t since = solution_.trace.size() - 1 - best_;
    solution_.stopped_early = since >= static_cast<size_t>(std::max(1, fit_.options.patience));
    return solution_.stopped_early ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  const LargeNetworkIteration& Best() const { return solution_.trace[best_]; }

 private:
  const LargeNetworkFit& fit_;
  Variables variables_;
  AdjointGradient* held_out_;
  const std::vector<double>& x_;
  const LargeNetworkProgress& progress_;
  LargeNetworkSolution& solution_;
  size_t best_ = 0;  // in the trace
  Clock::time_point begin_;
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
Result<AdjointGradient> MakeTraining(const LargeNetworkFit& fit,
                                     std::vector<ShortenedRecording>* shortened) {
  Result<AdjointGradient> whole =
      AdjointGradient::Create(fit.training, fit.model, fit.map, fit.sigmas);
  if (!whole.ok()) return whole;
  const AdjointCost start = whole.value().Evaluate(
      fit.shared.data(), fit.model.learned->weights.data(), nullptr, nullptr);
  if (start.ok()) return whole;
  std::vector<AdjointRecording> recordings;
  for (int i = 0; i < static_cast<int>(fit.training.size()); ++i) {
    AdjointRecording recording = fit.training[i];
    if (!start.status[i].ok) {
      shortened->push_back({i, start.status[i]});
      recording.horizon = start.status[i].frame;
    }
    recordings.push_back(recording);
  }
  return AdjointGradient::Create(recordings, fit.model, fit.map, fit.sigmas);
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

  std::vector<double> x = Variables(fit).Start();
  auto* cost = new TrainingCost(fit, &training.value());
  const ceres::GradientProblem problem(cost);  // takes ownership
  ceres::GradientProblemSolver::Options options = LbfgsOptions(fit.options);
  Judge judge(fit, fit.held_out.empty() ? nullptr : &held_out.value(), &x, progress, &solution);
  options.callbacks.push_back(&judge);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, x.data(), &summary);
  if (solution.trace.empty()) {
    return Error{"the training of the network could not start: " + summary.message};
  }
  solution.message = summary.message;
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.gradients = cost->gradients();
  solution.best_iteration = judge.Best().iteration;
  solution.final_cost = judge.Best().cost;
  solution.final_training_cost = judge.Best().training_cost;
  solution.best_held_out_cost = judge.Best().held_out_cost;
  solution.held_out_failures = judge.Best().held_out_failures;
  solution.seconds = summary.total_time_in_seconds;
  return solution;
}

}  // namespace pushid
