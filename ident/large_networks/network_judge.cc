// ident: points and judgement of a large network's training.
#include "ident/large_networks/network_judge.h"

#include <algorithm>

namespace pushid {

NetworkVariables::NetworkVariables(const LargeNetworkFit& fit)
    : fit_(fit), num_weights_(fit.model.learned->num_weights()), shared_(fit.shared) {}

std::vector<double> NetworkVariables::Start() const {
  std::vector<double> start = fit_.model.learned->weights;
  start.resize(size(), 0.0);
  return start;
}

const std::vector<double>& NetworkVariables::Shared(const double* variables) {
  for (int i = 0; i < num_shared(); ++i) {
    shared_[i] = fit_.shared[i] + fit_.shared_prior[i].unit * variables[num_weights_ + i];
  }
  return shared_;
}

double NetworkVariables::AddPriors(const double* variables, double* gradient) const {
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

void NetworkVariables::Scale(const std::vector<double>& by_shared, double* gradient) const {
  for (int i = 0; i < num_shared(); ++i) {
    gradient[num_weights_ + i] = by_shared[i] * fit_.shared_prior[i].unit;
  }
}

std::vector<AdjointRecording> Shortened(const LargeNetworkFit& fit,
                                        const std::vector<ShortenedRecording>& shortened) {
  std::vector<AdjointRecording> recordings = fit.training;
  for (const ShortenedRecording& one : shortened) {
    recordings[one.training].horizon = one.status.frame;
  }
  return recordings;
}

NetworkJudge::NetworkJudge(const LargeNetworkFit& fit, AdjointGradient* held_out,
                           const std::vector<double>* x, const LargeNetworkProgress& progress,
                           LargeNetworkSolution* solution)
    : fit_(fit),
      variables_(fit),
      held_out_(held_out),
      x_(*x),
      progress_(progress),
      solution_(*solution) {}

LargeNetworkIteration NetworkJudge::Now(const ceres::IterationSummary& summary) {
  LargeNetworkIteration now;
  now.iteration = summary.iteration;
  now.cost = summary.cost;
  now.gradient = summary.gradient_max_norm;
  now.training_failures = solution_.training_failures;
  const std::vector<double>& shared = variables_.Shared(x_.data());
  now.training_cost = now.cost - variables_.AddPriors(x_.data(), nullptr);
  if (held_out_ != nullptr) {
    const AdjointCost judged = held_out_->Evaluate(shared.data(), x_.data(), nullptr, nullptr);
    now.held_out_cost = judged.cost;
    now.held_out_failures = judged.num_failed();
  }
  now.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  return now;
}

ceres::CallbackReturnType NetworkJudge::operator()(const ceres::IterationSummary& summary) {
  if (!solution_.trace.empty() && !summary.step_is_successful) return ceres::SOLVER_CONTINUE;
  const bool first = solution_.trace.empty();
  solution_.trace.push_back(Now(summary));
  const LargeNetworkIteration& now = solution_.trace.back();
  if (first) {
    solution_.initial_cost = now.cost;
    solution_.initial_training_cost = now.training_cost;
    solution_.initial_held_out_cost = now.held_out_cost;
  }
  const LargeNetworkIteration& best = solution_.trace[best_];
  if (first || held_out_ == nullptr ||
      std::pair(now.held_out_failures, now.held_out_cost) <
          std::pair(best.held_out_failures, best.held_out_cost)) {
    best_ = solution_.trace.size() - 1;
    solution_.weights.assign(x_.begin(), x_.begin() + variables_.num_weights());
    solution_.shared = variables_.Shared(x_.data());
  }
  if (progress_ && !progress_(now)) return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  const size_t since = solution_.trace.size() - 1 - best_;
  solution_.stopped_early = since >= static_cast<size_t>(std::max(1, fit_.options.patience));
  return solution_.stopped_early ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
}

}  // namespace pushid
