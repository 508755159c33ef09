// ident: two forecasters, their blend, and how far hips are from it.
#include "ident/observed/first_frames.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace pushid {
namespace {

constexpr double kErrorWindow = 0.05;  // s, of which an error of velocity is the mean

}  // namespace

SeenFrame FrameAt(const PendulumRecording& recording, int frame) {
  SeenFrame seen{HipsAt(recording, frame), {}};
  for (const auto& states : recording.states) seen.states.push_back(states[frame]);
  return seen;
}

FirstFrames::FirstFrames(const IdentifiedModel& model, double tail,
                         const PendulumRecording& recording, HipPaths rollout, int frames)
    : recording_(&recording),
      rollout_(std::move(rollout)),
      frames_(frames),
      input_(ForecastFilter(model, tail, recording, frames)),
      beside_(recording.hip.size(), Vector3<double>::Zero()) {}

double FirstFrames::seconds() const { return (observed() - 1) * recording_->scene.dt; }

void FirstFrames::Observe(SeenFrame frame) {
  if (observed() >= frames()) return;
  if (input_) {
    std::vector<bool> seen;
    for (size_t n = 0; n < beside_.size(); ++n)
      seen.push_back(frame.hips.Sees(static_cast<int>(n)));
    input_->Observe(frame.states, seen);
    for (size_t n = 0; n < beside_.size(); ++n) {
      if (!seen[n] || !input_->status().ok) continue;
      beside_[n] = frame.hips.hip[n] - HipPosition(recording_->scene.people[n].body,
                                                   input_->State(static_cast<int>(n)).q);
    }
  }
  seen_.push_back(std::move(frame));
}

// Frame 0 always was.
int FirstFrames::LastSeen(int person, int until) const {
  while (until > 0 && !seen_[until - 1].hips.Sees(person)) --until;
  return until;
}

Vector3<double> FirstFrames::HipAt(int person, int frame) const {
  return frame == 0 ? recording_->hip[person][0] : seen_[frame - 1].hips.hip[person];
}

std::vector<Vector3<double>> FirstFrames::LastHips() const {
  std::vector<Vector3<double>> hips;
  for (int n = 0; n < recording_->num_people(); ++n) {
    hips.push_back(HipAt(n, LastSeen(n, observed() - 1)));
  }
  return hips;
}

HipPath FirstFrames::Physics(int person) const {
  const double dt = recording_->scene.dt;
  const int window = std::max(1, static_cast<int>(std::lround(kErrorWindow / dt)));
  const int last = LastSeen(person, observed() - 1);
  const int before = LastSeen(person, std::max(0, last - window));
  const auto error = [&](int frame) -> Vector3<double> {
    if (frame == 0) return Vector3<double>::Zero();
    return HipAt(person, frame) - rollout_[person][frame];
  };
  const Vector3<double> off = error(last);
  Vector3<double> velocity = Vector3<double>::Zero();
  if (last > before) velocity = (off - error(before)) / ((last - before) * dt);
  HipPath path;
  for (int t = observed(); t < frames_; ++t) {
    const double reach = kErrorTime * (1.0 - std::exp(-(t - last) * dt / kErrorTime));
    path.push_back(rollout_[person][t] + off + reach * velocity);
  }
  return path;
}

TwoForecasts FirstFrames::Forecasts() const {
  TwoForecasts two;
  for (size_t n = 0; n < rollout_.size(); ++n) two.physics.push_back(Physics(static_cast<int>(n)));
  if (!input_) return two;
  two.input_status = input_->Forecast(&two.input_path);
  if (!two.input_status.ok) return two;
  for (size_t n = 0; n < beside_.size(); ++n) {
    HipPath& hips = two.input.emplace_back();
    for (int t = observed(); t < frames(); ++t) {
      const Vector4<double>& q = two.input_path.At(t, static_cast<int>(n)).q;
      hips.push_back(beside_[n] + HipPosition(recording_->scene.people[n].body, q));
    }
  }
  return two;
}

namespace {

constexpr double kPhysicsAlone = 0.25 - 1e-9;  // s
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

std::optional<double> InputShare(double input_time, const HipPaths& physics, const HipPaths& input,
                                 double seconds, ForecastUse use) {
  const bool asks_physics = use != ForecastUse::kInput && !physics.empty();
  const bool asks_input = use != ForecastUse::kPhysics && !input.empty();
  if (!asks_physics && !asks_input) return std::nullopt;
  if (!asks_input) return 0.0;
  if (!asks_physics) return 1.0;
  return seconds < kPhysicsAlone ? 0.0 : std::min(1.0, std::sqrt(input_time / seconds));
}

HipPaths Blended(double share, const HipPaths& physics, const HipPaths& input) {
  HipPaths blended = share > 0.0 ? input : physics;
  for (size_t n = 0; share > 0.0 && share < 1.0 && n < blended.size(); ++n) {
    for (size_t t = 0; t < blended[n].size(); ++t) {
      blended[n][t] = (1.0 - share) * physics[n][t] + share * input[n][t];
    }
  }
  return blended;
}

Eigen::Vector4d ScaleFeatures(double ahead, double seconds, double speed) {
  return {1.0, std::log(ahead / kAhead), std::log((seconds + kLeastSeconds) / kSeconds),
          std::log(speed + kLeastSpeed)};
}

HipDistribution::HipDistribution(const std::array<ErrorScale, 3>& errors,
                                 const Eigen::Matrix3d& axes, HipPaths centre,
                                 const std::vector<Vector3<double>>& from, double seconds,
                                 double dt)
    : centre_(std::move(centre)) {
  // A world axis has the quantiles of the axis of the push that it is nearest to.
  for (int i = 0; i < 3; ++i) {
    Eigen::Index nearest = 0;
    axes.row(i).cwiseAbs().maxCoeff(&nearest);
    quantiles_[i] = QuantilesOf(errors[nearest]);
  }
  for (size_t n = 0; n < centre_.size(); ++n) {
    scale_.emplace_back();
    for (size_t t = 0; t < centre_[n].size(); ++t) {
      const double ahead = (static_cast<double>(t) + 1.0) * dt;
      const Eigen::Vector4d features =
          ScaleFeatures(ahead, seconds, (centre_[n][t] - from[n]).norm() / ahead);
      Vector3<double> variance;
      for (int i = 0; i < 3; ++i) {
        variance[i] = std::exp(2.0 * errors[i].coefficients.dot(features));
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

}  // namespace pushid
