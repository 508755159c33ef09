// ident: mixtures of normal distributions over the nodes of an effect.
#include "ident/prediction/hip_distribution.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

constexpr double kReach = 8.0;  // standard deviations in which a component lies
constexpr int kHalvings = 50;

}  // namespace

double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

HipDistribution::HipDistribution(const RecordingFilter& filter, const RecordingEffect& effect,
                                 const HipPaths& centre) {
  points_ = filter.Mixture(effect, &weights_);
  const Vector3<double> wider = effect.Widening(filter.seconds());
  const Eigen::Matrix3d& axes = filter.Axes();
  for (size_t n = 0; n < points_.size(); ++n) {
    for (size_t t = 0; t < points_[n].size(); ++t) {
      MixturePoint& point = points_[n][t];
      Vector3<double> mean = Vector3<double>::Zero();
      for (size_t j = 0; j < weights_.size(); ++j) mean += weights_[j] * point.mean[j];
      for (Vector3<double>& component : point.mean) {
        component = centre[n][t] + axes * wider.cwiseProduct(component - mean);
      }
      const Vector3<double> variance = wider.cwiseProduct(point.deviation).cwiseAbs2();
      point.deviation = (axes.cwiseAbs2() * variance).cwiseSqrt();
    }
  }
}

double HipDistribution::Cdf(int person, int frame, int axis, double value) const {
  const MixturePoint& point = points_[person][frame];
  double sum = 0.0;
  for (size_t j = 0; j < weights_.size(); ++j) {
    sum += weights_[j] * NormalCdf((value - point.mean[j][axis]) / point.deviation[axis]);
  }
  return sum;
}

double HipDistribution::Quantile(int person, int frame, int axis, double share) const {
  const MixturePoint& point = points_[person][frame];
  double low = point.mean[0][axis], high = low;
  for (const Vector3<double>& mean : point.mean) {
    low = std::min(low, mean[axis]);
    high = std::max(high, mean[axis]);
  }
  low -= kReach * point.deviation[axis];
  high += kReach * point.deviation[axis];
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (Cdf(person, frame, axis, middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

HipPaths HipDistribution::Draw(Random* random) const {
  size_t component = 0;
  double left = random->Unit();
  for (size_t j = 0; j < weights_.size() && left >= 0.0; ++j) {
    if (weights_[j] > 0.0) component = j;  // rounding never ends in one that cannot be
    left -= weights_[j];
  }
  HipPaths paths;
  for (const std::vector<MixturePoint>& person : points_) {
    Vector3<double> out;
    for (double& deviations : out) deviations = random->Normal();
    paths.emplace_back();
    for (const MixturePoint& point : person) {
      paths.back().push_back(point.mean[component] + point.deviation.cwiseProduct(out));
    }
  }
  return paths;
}

}  // namespace pushid
