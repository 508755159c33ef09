// ident: L-BFGS over the weights of a large network.
#include "ident/large_networks/large_network_fit.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <cmath>
#include <memory>
#include <utility>

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
    if (MaybeError error =
            SolveByAdam(fit, Shortened(fit, solution.shortened), &judge, &x, &solution)) {
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
