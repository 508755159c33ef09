// ident: the weights of the least mean distance, and how far hips are from what they say.
#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ident/observed/learn_forecasts.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr int kLogits = 3 * kNumForecasters;
constexpr int kFrameStep = 4;          // of the frames ahead that are looked at
constexpr double kCorner = 0.02;       // m, below which a distance counts by its square
constexpr double kPriorWeight = 0.03;  // of half the squared distance of logits from the prior's, m
constexpr double kLeastError = 1e-3;   // m
constexpr size_t kFewestErrors = 100;

// A hip some frames ahead, by every forecaster, less the one that was measured.
struct StackedError {
  std::array<Vector3<double>, kNumForecasters> off;
  std::array<bool, kNumForecasters> available;
  Eigen::Vector3d features;

  template <typename T>
  bool operator()(const T* logits, T* error) const {
    using std::exp;
    T weights[kNumForecasters], sum(0.0);
    for (int c = 0; c < kNumForecasters; ++c) {
      T logit(0.0);
      for (int i = 0; i < 3; ++i) logit += logits[3 * c + i] * features[i];
      weights[c] = available[c] ? exp(logit) : T(0.0);
      sum += weights[c];
    }
    for (int i = 0; i < 3; ++i) {
      error[i] = T(0.0);
      for (int c = 0; c < kNumForecasters; ++c) error[i] += weights[c] / sum * off[c][i];
    }
    return true;
  }
};

// Ties every logit to its prior.
struct LogitPrior {
  std::array<Eigen::Vector3d, kNumForecasters> prior;
  double root_weight;

  template <typename T>
  bool operator()(const T* logits, T* residual) const {
    for (int i = 0; i < kLogits; ++i) {
      residual[i] = root_weight * (logits[i] - prior[i / 3][i % 3]);
    }
    return true;
  }
};

}  // namespace

std::array<Eigen::Vector3d, kNumForecasters> LearnLogits(const std::vector<ForecastTrial>& trials,
                                                         int left_out) {
  std::array<Eigen::Vector3d, kNumForecasters> logits = ForecastStack::DefaultLogits();
  std::vector<StackedError> errors;
  std::vector<double> weights;
  double used = 0.0;
  for (const ForecastTrial& trial : trials) {
    if (trial.fold == left_out || trial.seconds == 0.0) continue;
    const std::array<bool, kNumForecasters> available =
        Available(trial.forecasts, trial.seconds, ForecastUse::kStack);
    const size_t before = errors.size();
    for (size_t n = 0; n < trial.measured.size(); ++n) {
      for (size_t t = kFrameStep - 1; t < trial.measured[n].size(); t += kFrameStep) {
        if (!trial.seen[n][t]) continue;
        StackedError error{{}, available, LogitFeatures(trial.seconds, (t + 1.0) * trial.dt)};
        for (int c = 0; c < kNumForecasters; ++c) {
          error.off[c] = available[c]
                             ? Vector3<double>(trial.forecasts[c][n][t] - trial.measured[n][t])
                             : Vector3<double>::Zero();
        }
        errors.push_back(error);
      }
    }
    const double added = static_cast<double>(errors.size() - before);
    weights.resize(errors.size(), added > 0.0 ? 1.0 / added : 0.0);
    used += added > 0.0 ? 1.0 : 0.0;
  }
  if (errors.empty()) return logits;
  ceres::Problem problem;
  double* const at = logits[0].data();
  static_assert(sizeof logits == kLogits * sizeof(double), "logits lie in one piece");
  for (size_t i = 0; i < errors.size(); ++i) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<StackedError, 3, kLogits>(new StackedError(errors[i])),
        new ceres::ScaledLoss(new ceres::SoftLOneLoss(kCorner), weights[i] / (used * kCorner),
                              ceres::TAKE_OWNERSHIP),
        at);
  }
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LogitPrior, kLogits, kLogits>(
                               new LogitPrior{logits, std::sqrt(kPriorWeight)}),
                           nullptr, at);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-6;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return logits;
}

namespace {

// A hip some frames ahead, on the axes of the push. A trial counts once, however many frames it
// has: so does a recording in the share of its frames that a band holds.
struct ScaledError {
  Eigen::Vector4d features;
  Vector3<double> off;
  double weight;
};

void AddErrors(const ForecastTrial& trial, const HipPaths& centre,
               std::vector<ScaledError>* errors) {
  const size_t before = errors->size();
  for (size_t n = 0; n < centre.size(); ++n) {
    for (size_t t = 0; t < centre[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      const double ahead = (static_cast<double>(t) + 1.0) * trial.dt;
      const double speed = (centre[n][t] - trial.from[n]).norm() / ahead;
      errors->push_back({ScaleFeatures(ahead, trial.seconds, speed),
                         trial.axes.transpose() * (trial.measured[n][t] - centre[n][t]), 0.0});
    }
  }
  for (size_t i = before; i < errors->size(); ++i) {
    (*errors)[i].weight = 1.0 / static_cast<double>(errors->size() - before);
  }
}

std::vector<double> WeightedQuantiles(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double total = 0.0, below = 0.0;
  for (const auto& [value, weight] : values) total += weight;
  std::vector<double> quantiles;
  size_t at = 0;
  for (double share : kErrorShares) {
    while (at + 1 < values.size() && below + values[at].second < share * total) {
      below += values[at++].second;
    }
    quantiles.push_back(std::max(1e-9, values[at].first));
  }
  return quantiles;
}

}  // namespace

std::array<ErrorScale, 3> LearnErrorScales(const std::vector<ForecastTrial>& trials,
                                           const std::vector<HipPaths>& centre) {
  std::array<ErrorScale, 3> scales;
  std::vector<ScaledError> errors;
  for (size_t i = 0; i < trials.size(); ++i) AddErrors(trials[i], centre[i], &errors);
  if (errors.size() < kFewestErrors) return scales;
  Eigen::Matrix4d gram = 1e-6 * Eigen::Matrix4d::Identity();
  for (const ScaledError& e : errors) gram += e.weight * e.features * e.features.transpose();
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const ScaledError& e : errors) {
      right += e.weight * std::log(std::max(kLeastError, std::abs(e.off[axis]))) * e.features;
    }
    ErrorScale& scale = scales[axis];
    scale.coefficients = SolveSymmetric(Eigen::MatrixXd(gram), Eigen::VectorXd(right));
    std::vector<std::pair<double, double>> over;  // and the weight
    for (const ScaledError& e : errors) {
      over.emplace_back(std::abs(e.off[axis]) / std::exp(scale.coefficients.dot(e.features)),
                        e.weight);
    }
    scale.quantiles = WeightedQuantiles(std::move(over));
  }
  return scales;
}

}  // namespace pushid
