// ident: weights, mixtures and distributions of hips to come.
#include "ident/observed/forecast_stack.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pushid {
namespace {

constexpr double kSeconds = 0.35, kAhead = 0.5, kLeastSeconds = 0.05, kLeastSpeed = 0.05;
constexpr int kNumShares = static_cast<int>(std::size(kErrorShares));
constexpr double kNormal[] = {0.0627, 0.1257, 0.1891, 0.2533, 0.3186, 0.3853, 0.4538,
                              0.5244, 0.5978, 0.6745, 0.7554, 0.8416, 0.9346, 1.0364,
                              1.1503, 1.2816, 1.4395, 1.6449, 1.9600, 2.5758};

std::vector<double> QuantilesOf(const ErrorScale& error) {
  if (static_cast<int>(error.quantiles.size()) == kNumShares) return error.quantiles;
  return {std::begin(kNormal), std::end(kNormal)};
}

// By how much the logarithm of the share above falls between the last two quantiles.
double LastFall() {
  return std::log((1.0 - kErrorShares[kNumShares - 2]) / (1.0 - kErrorShares[kNumShares - 1]));
}

// The share of |z| below a value, and its inverse: straight between the shares, exponential beyond.
double ShareBelow(const std::vector<double>& quantiles, double z) {
  double share = 0.0, at = 0.0;
  for (int i = 0; i < kNumShares; ++i) {
    if (z <= quantiles[i]) {
      const double width = quantiles[i] - at;
      return share + (width > 0.0 ? (z - at) / width : 1.0) * (kErrorShares[i] - share);
    }
    share = kErrorShares[i], at = quantiles[i];
  }
  const double last = quantiles[kNumShares - 1] - quantiles[kNumShares - 2];
  return 1.0 - (1.0 - share) * std::exp(-(z - at) * LastFall() / std::max(1e-9, last));
}

double QuantileAt(const std::vector<double>& quantiles, double share) {
  double below = 0.0, at = 0.0;
  for (int i = 0; i < kNumShares; ++i) {
    if (share <= kErrorShares[i]) {
      return at + (share - below) / (kErrorShares[i] - below) * (quantiles[i] - at);
    }
    below = kErrorShares[i], at = quantiles[i];
  }
  const double last = quantiles[kNumShares - 1] - quantiles[kNumShares - 2];
  return at + last / LastFall() * std::log((1.0 - below) / std::max(1e-12, 1.0 - share));
}

}  // namespace

Eigen::Vector3d LogitFeatures(double seconds, double ahead) {
  return {1.0, std::log(seconds / kSeconds), std::log(ahead / kAhead)};
}

ForecastWeights WeightsOf(const std::array<Eigen::Vector3d, kNumForecasters>& logits,
                          const std::array<bool, kNumForecasters>& available, double seconds,
                          double ahead) {
  const Eigen::Vector3d features = LogitFeatures(seconds, ahead);
  ForecastWeights weights{};
  double most = -1e300, sum = 0.0;
  for (int c = 0; c < kNumForecasters; ++c) {
    if (available[c]) most = std::max(most, logits[c].dot(features));
  }
  for (int c = 0; c < kNumForecasters; ++c) {
    if (available[c]) sum += weights[c] = std::exp(logits[c].dot(features) - most);
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::array<bool, kNumForecasters> Available(const ForecastsOfAll& forecasts, double seconds,
                                            ForecastUse use) {
  // Who is asked: one alone, or everybody; with frame 0 alone physics.
  const auto asked = [&](Forecaster who) {
    switch (use) {
      case ForecastUse::kStack:
        return seconds > 0.0 || who == Forecaster::kPhysics;
      case ForecastUse::kPhysics:
        return who == Forecaster::kPhysics;
      case ForecastUse::kInput:
        return who == Forecaster::kInput;
      case ForecastUse::kKinematic:
        return who == Forecaster::kKinematic;
    }
    return false;  // no such use
  };
  std::array<bool, kNumForecasters> available{};
  for (int c = 0; c < kNumForecasters; ++c) {
    available[c] = asked(static_cast<Forecaster>(c)) && !forecasts[c].empty();
  }
  return available;
}

std::vector<ForecastWeights> WeightsAhead(const ForecastStack& stack,
                                          const ForecastsOfAll& forecasts, double seconds,
                                          double dt, ForecastUse use) {
  const std::array<bool, kNumForecasters> available = Available(forecasts, seconds, use);
  std::vector<ForecastWeights> weights;
  const auto first = std::find(available.begin(), available.end(), true);
  if (first == available.end()) return weights;
  const size_t frames = forecasts[first - available.begin()].at(0).size();
  for (size_t t = 0; t < frames; ++t) {
    weights.push_back(WeightsOf(stack.logits, available, std::max(seconds, dt),
                                (static_cast<double>(t) + 1.0) * dt));
  }
  return weights;
}

HipPaths Stacked(const std::vector<ForecastWeights>& weights, const ForecastsOfAll& forecasts) {
  HipPaths stacked;
  if (weights.empty()) return stacked;
  for (int c = 0; c < kNumForecasters; ++c) {
    for (size_t n = 0; n < forecasts[c].size(); ++n) {
      if (stacked.size() <= n) stacked.emplace_back(weights.size(), Vector3<double>::Zero());
      for (size_t t = 0; t < weights.size(); ++t) {
        if (weights[t][c] > 0.0) stacked[n][t] += weights[t][c] * forecasts[c][n][t];
      }
    }
  }
  return stacked;
}

Eigen::Vector4d ScaleFeatures(double ahead, double seconds, double speed) {
  return {1.0, std::log(ahead / kAhead), std::log((seconds + kLeastSeconds) / kSeconds),
          std::log(speed + kLeastSpeed)};
}

HipDistribution::HipDistribution(const ForecastStack& stack, const Eigen::Matrix3d& axes,
                                 HipPaths centre, const std::vector<Vector3<double>>& from,
                                 double seconds, double dt)
    : centre_(std::move(centre)) {
  // A world axis has the quantiles of the axis of the push that it is nearest to.
  for (int i = 0; i < 3; ++i) {
    Eigen::Index nearest = 0;
    axes.row(i).cwiseAbs().maxCoeff(&nearest);
    quantiles_[i] = QuantilesOf(stack.errors[nearest]);
  }
  for (size_t n = 0; n < centre_.size(); ++n) {
    scale_.emplace_back();
    for (size_t t = 0; t < centre_[n].size(); ++t) {
      const double ahead = (static_cast<double>(t) + 1.0) * dt;
      const Eigen::Vector4d features =
          ScaleFeatures(ahead, seconds, (centre_[n][t] - from[n]).norm() / ahead);
      Vector3<double> variance;
      for (int i = 0; i < 3; ++i) {
        variance[i] = std::exp(2.0 * stack.errors[i].coefficients.dot(features));
      }
      scale_[n].push_back((axes.cwiseAbs2() * variance).cwiseSqrt());
    }
  }
}

double HipDistribution::Cdf(int person, int frame, int axis, double value) const {
  const double z = (value - centre_[person][frame][axis]) / Scale(person, frame, axis);
  const double share = 0.5 * ShareBelow(quantiles_[axis], std::abs(z));
  return z < 0.0 ? 0.5 - share : 0.5 + share;
}

double HipDistribution::Quantile(int person, int frame, int axis, double share) const {
  const double z = QuantileAt(quantiles_[axis], std::abs(2.0 * share - 1.0));
  return centre_[person][frame][axis] + (share < 0.5 ? -1.0 : 1.0) * z * Scale(person, frame, axis);
}

double HipDistribution::Crps(int person, int frame, int axis, double value) const {
  // Twice the mean pinball loss over levels.
  constexpr int kLevels = 99;
  double sum = 0.0;
  for (int i = 1; i <= kLevels; ++i) {
    const double level = static_cast<double>(i) / (kLevels + 1);
    const double off = value - Quantile(person, frame, axis, level);
    sum += 2.0 * off * (off >= 0.0 ? level : level - 1.0) / kLevels;
  }
  return sum;
}

HipPaths HipDistribution::Draw(Random* random) const {
  HipPaths paths;
  for (size_t n = 0; n < centre_.size(); ++n) {
    Vector3<double> out;
    for (int i = 0; i < 3; ++i) {
      const double share = 2.0 * random->Unit() - 1.0;
      out[i] = std::copysign(QuantileAt(quantiles_[i], std::abs(share)), share);
    }
    paths.emplace_back();
    for (size_t t = 0; t < centre_[n].size(); ++t) {
      paths.back().push_back(centre_[n][t] + scale_[n][t].cwiseProduct(out));
    }
  }
  return paths;
}

}  // namespace pushid
