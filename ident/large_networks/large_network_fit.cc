// ident: passes of Adam over the weights of a large network.
#include "ident/large_networks/large_network_fit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "datasets/files/random.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"

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

// Shortens a gradient to twice the mean length so far.
void Clip(double* mean, Eigen::ArrayXd* gradient) {
  constexpr double kLongest = 2.0, kKept = 0.95;
  const double length = gradient->matrix().norm();
  const double most = *mean > 0.0 ? std::min(length, kLongest * *mean) : length;
  if (most < length) *gradient *= most / length;
  *mean = *mean > 0.0 ? kKept * *mean + (1.0 - kKept) * most : length;
}

// The cost and its gradient by x = [weights, (shared - start) / unit], batch by batch.
class Training {
 public:
  static Result<Training> Create(const LargeNetworkFit& fit,
                                 std::vector<AdjointRecording> recordings) {
    Training made(fit);
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

  std::vector<double> Start() const {
    std::vector<double> start = fit_.model.learned->weights;
    start.resize(num_weights_ + fit_.shared.size(), 0.0);
    return start;
  }

  std::vector<double> Shared(const std::vector<double>& x) const {
    std::vector<double> shared = fit_.shared;
    for (size_t i = 0; i < shared.size(); ++i) {
      shared[i] += fit_.shared_prior[i].unit * x[num_weights_ + i];
    }
    return shared;
  }

  // Calls step(gradient) for each batch, in random order, which may move *x; returns the pass.
  template <typename Step>
  LargeNetworkPass Pass(const std::vector<double>& x, const Step& step) {
    LargeNetworkPass pass;
    std::vector<int> order(batches_.size());
    std::iota(order.begin(), order.end(), 0);
    random_.Shuffle(&order);
    const double share = 1.0 / static_cast<double>(batches_.size());
    std::vector<double> by_shared(fit_.shared.size());
    Eigen::ArrayXd gradient(x.size()), of_priors(x.size());
    for (int k : order) {
      const std::vector<double> shared = Shared(x);
      gradient.setZero();
      const AdjointCost cost =
          batches_[k].Evaluate(shared.data(), x.data(), by_shared.data(), gradient.data());
      for (size_t i = 0; i < by_shared.size(); ++i) {
        gradient[num_weights_ + i] = by_shared[i] * fit_.shared_prior[i].unit;
      }
      of_priors.setZero();
      pass.cost += cost.cost + share * AddPriors(x, shared, &of_priors);
      pass.failures += cost.num_failed();
      gradient += share * of_priors;
      step(&gradient);
    }
    return pass;
  }

 private:
  explicit Training(const LargeNetworkFit& fit)
      : fit_(fit), num_weights_(fit.model.learned->num_weights()), random_(fit.options.seed) {}

  // Returns the cost of the priors, and adds their gradient.
  double AddPriors(const std::vector<double>& x, const std::vector<double>& shared,
                   Eigen::ArrayXd* gradient) const {
    double cost = 0.0;
    const double sigma = fit_.options.weight_sigma;
    if (sigma > 0.0) {
      const Eigen::Map<const Eigen::VectorXd> weights(x.data(), num_weights_);
      cost += 0.5 * weights.squaredNorm() / (sigma * sigma);
      gradient->head(num_weights_) += weights.array() / (sigma * sigma);
    }
    for (size_t i = 0; i < shared.size(); ++i) {
      const SharedPrior& prior = fit_.shared_prior[i];
      const double r = (shared[i] - prior.mean) / prior.sigma;
      cost += 0.5 * r * r;
      (*gradient)[num_weights_ + i] += r / prior.sigma * prior.unit;
    }
    return cost;
  }

  const LargeNetworkFit& fit_;
  int num_weights_;
  Random random_;
  std::vector<AdjointGradient> batches_;
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
  if (fit.shared.size() != fitted || fit.shared_prior.size() != fitted) {
    return Error{"one value and one prior are needed for each of " + std::to_string(fitted) +
                 " shared parameters"};
  }
  return std::nullopt;
}

// Recordings whose rollout fails at the start.
Result<std::vector<FailedRollout>> FailingAtTheStart(const LargeNetworkFit& fit) {
  Result<AdjointGradient> whole =
      AdjointGradient::Create(fit.training, fit.model, fit.map, fit.sigmas);
  if (!whole.ok()) return whole.error();
  const AdjointCost start = whole.value().Evaluate(
      fit.shared.data(), fit.model.learned->weights.data(), nullptr, nullptr);
  std::vector<FailedRollout> shortened;
  for (int i = 0; !start.ok() && i < static_cast<int>(fit.training.size()); ++i) {
    if (!start.status[i].ok) shortened.push_back({i, start.status[i]});
  }
  return shortened;
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

LargeNetworkOptions OptionsFor(const LearnedTerms& learned) {
  LargeNetworkOptions options;
  if (learned.shape.ldp()) options.rate = options.last_rate = 3e-4;
  return options;
}

Result<LargeNetworkSolution> FitLargeNetwork(const LargeNetworkFit& fit,
                                             const LargeNetworkProgress& progress) {
  if (const MaybeError error = CheckFit(fit)) return *error;
  Result<std::vector<FailedRollout>> failing = FailingAtTheStart(fit);
  if (!failing.ok()) return failing.error();
  LargeNetworkSolution solution;
  solution.shortened = std::move(failing.value());
  std::vector<AdjointRecording> recordings = fit.training;
  for (const FailedRollout& one : solution.shortened) {
    recordings[one.recording].horizon = one.status.frame;
  }
  Result<Training> training = Training::Create(fit, std::move(recordings));
  if (!training.ok()) return training.error();
  std::vector<double> x = training.value().Start();
  Adam adam(static_cast<Eigen::Index>(x.size()));
  double mean_length = 0.0;
  const int passes = fit.options.passes;
  const double fall = fit.options.last_rate / fit.options.rate;
  for (int pass = 0; pass <= passes; ++pass) {
    const double rate = pass == 0 ? 0.0 : fit.options.rate * std::pow(fall, double(pass) / passes);
    double steepest = 0.0;
    LargeNetworkPass made = training.value().Pass(x, [&](Eigen::ArrayXd* gradient) {
      steepest = std::max(steepest, gradient->abs().maxCoeff());
      Clip(&mean_length, gradient);
      if (rate > 0.0) adam.Step(*gradient, rate, &x);
    });
    if (!std::isfinite(made.cost) || !std::isfinite(steepest)) {
      return Error{"pass " + std::to_string(pass) +
                   " of the network's training has a cost or a gradient that is not finite"};
    }
    made.pass = pass;
    solution.passes.push_back(made);
    if (progress && !progress(made)) break;
  }
  solution.weights.assign(x.begin(), x.begin() + fit.model.learned->num_weights());
  solution.shared = training.value().Shared(x);
  return solution;
}

// The training inside a fit, which programs that link this library have as LargeNetworkTraining()
// (solver/solver.h).

namespace {

// The recordings with the weight that each has in the cost of a fit, and the parameters of its
// people.
std::vector<AdjointRecording> Weighed(const FitProblem& problem) {
  const FitPoint point = problem.NominalPoint();
  std::vector<AdjointRecording> weighed;
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    const PendulumRecording& recording = problem.recordings()[i];
    weighed.push_back({&recording, problem.Weight(static_cast<int>(i), 0), 0});
    for (const std::string& unit : PoolingUnits(recording, problem.map().pool_by)) {
      weighed.back().held.push_back(problem.Parameters(point, unit));
    }
  }
  return weighed;
}

Result<FitOptions> TrainByGradient(const std::vector<PendulumRecording>& recordings,
                                   const FitOptions& options, const SolveProgress& progress) {
  const FitProblem physics(recordings, PhysicsAlone(options));
  LargeNetworkFit fit;
  fit.training = Weighed(physics);
  fit.model = options.model;
  fit.map = options.table.Map();
  fit.map.num_weights = static_cast<int>(options.model.learned->weights.size());
  for (const FittedParameter& f : fit.map.fitted) {
    fit.shared.push_back(ToFitted(f.transform, options.table[f.parameter].nominal));
  }
  fit.shared_prior = SharedPriors(options.table, fit.map);
  fit.sigmas = options.sigmas;
  fit.options = OptionsFor(*options.model.learned);
  fit.options.weight_sigma = options.network_prior;
  fit.options.seed = options.seed;
  const Result<LargeNetworkSolution> trained =
      FitLargeNetwork(fit, [&progress](const LargeNetworkPass& p) {
        const std::string failing =
            p.failures > 0 ? ", " + std::to_string(p.failures) + " rollouts leave the domain" : "";
        if (progress) progress("network by its gradient" + failing, p.pass, p.cost);
        return true;
      });
  if (!trained.ok()) return trained.error();
  if (trained.value().passes.back().failures == static_cast<int>(fit.training.size())) {
    return Error{"in the last pass of the training every rollout left the domain"};
  }

  FitOptions held = options;
  held.model.learned = trained.value().Network(*options.model.learned);
  held.hold_network = true;
  held.horizons = {0};
  const ParameterSet<double> learned =
      fit.map.Apply<double>(trained.value().shared.data(), nullptr);
  for (ParameterSpec& spec : held.table.specs) spec.nominal = learned[spec.id];
  return held;
}

}  // namespace
}  // namespace pushid

// The linker keeps this object for the sake of the name (ident/CMakeLists.txt).
extern "C" {
bool pushid_large_networks = (pushid::LargeNetworkTraining() = pushid::TrainByGradient, true);
}
