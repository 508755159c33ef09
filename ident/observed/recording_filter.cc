// ident: nodes of the effect, filtered frame by frame.
#include "ident/observed/recording_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ident/model/push_range.h"
#include "ident/problem/own_axes.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kLeastUnit = 0.3;  // m/s, of a push that hardly moves anybody: errors are not zero
const Vector3<double> kAxisScale(1.0, 0.3, 0.3);
constexpr double kFailed = std::numeric_limits<double>::infinity();

}  // namespace

Eigen::Matrix3d PushAxes(const PendulumRecording& recording) {
  const Eigen::Vector2d along = PushDirection(recording);
  Eigen::Matrix3d axes;
  axes << along.x(), -along.y(), 0.0, along.y(), along.x(), 0.0, 0.0, 0.0, 1.0;
  return axes;
}

SeenHips HipsAt(const PendulumRecording& recording, int frame) {
  SeenHips hips;
  for (int n = 0; n < recording.num_people(); ++n) {
    hips.hip.push_back(recording.hip[n][frame]);
    hips.seen.push_back(recording.Weight(n, frame) > 0.0);
  }
  return hips;
}

RecordingFilter::RecordingFilter(const IdentifiedModel& model, const PendulumRecording& recording,
                                 int frames)
    : dt_(recording.scene.dt),
      unit_(std::max(kLeastUnit, WholePushSpeed(model, recording))),
      frames_(frames),
      axes_(PushAxes(recording)),
      process_(recording.scene.num_people(), ErrorProcess(recording.scene.dt)),
      nodes_(EffectActs(model.options, recording) ? kEffectNodes : 1),
      misfit_(nodes_.size(), 0.0) {
  std::vector<double> effects(nodes_.size(), 0.0);
  for (size_t j = 0; j < nodes_.size() && acts(); ++j) effects[j] = EffectNode(static_cast<int>(j));
  std::vector<HipPaths> hips = HipsOfRollouts(model, recording, effects, frames);
  for (size_t j = 0; j < nodes_.size(); ++j) {
    Node& node = nodes_[j];
    node.hip = std::move(hips[j]);
    node.error.resize(node.hip.size());
    if (node.hip.empty()) misfit_[j] = kFailed;
  }
}

bool RecordingFilter::ok() const {
  return std::any_of(misfit_.begin(), misfit_.end(), [](double m) { return m < kFailed; });
}

Vector3<double> RecordingFilter::Scaled(const Vector3<double>& error) const {
  return (axes_.transpose() * error).cwiseQuotient(unit_ * kAxisScale);
}

void RecordingFilter::Update(const Vector3<double>& error, const ErrorProcess::Gains& gains,
                             Axis3* state, double* misfit) const {
  const Vector3<double> scaled = Scaled(error);
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) {
    ErrorProcess::State& now = (*state)[i];
    now = process_[0].Predicted(now);
    if (gains.variance == 0.0) continue;  // not seen
    const double innovation = scaled[i] - now.position;
    now.position += gains.position * innovation;
    now.velocity += gains.velocity * innovation;
    squares += innovation * innovation;
  }
  if (misfit != nullptr && gains.variance > 0.0) *misfit += squares / gains.variance;
}

void RecordingFilter::Observe(const SeenHips& frame) {
  const int t = observed_++;
  Seen seen{frame, {}};
  for (size_t n = 0; n < process_.size(); ++n) {
    const bool sees = frame.Sees(static_cast<int>(n));
    seen.gains.push_back(process_[n].Next(sees));
    if (sees) residuals_ += 3;
  }
  for (size_t j = 0; j < nodes_.size(); ++j) {
    Node& node = nodes_[j];
    for (size_t n = 0; n < node.hip.size(); ++n) {
      Update(frame.hip[n] - node.hip[n][t], seen.gains[n], &node.error[n], &misfit_[j]);
    }
  }
  seen_.push_back(std::move(seen));
}

EffectEstimate RecordingFilter::Effect(const RecordingEffect& effect) const {
  if (!acts()) return {};
  if (observed_ == 1) return {0.0, effect.spread};
  return MeanEffect(EffectWeights(misfit_, effect.spread, effect.error_scale));
}

HipPaths RecordingFilter::ForecastOf(const HipPaths& rollout) const {
  HipPaths forecast;
  const int now = observed_ - 1;
  for (size_t n = 0; n < rollout.size(); ++n) {
    Axis3 state{};
    for (int t = 1; t <= now; ++t) {
      const Seen& seen = seen_[t - 1];
      Update(seen.hips.hip[n] - rollout[n][t], seen.gains[n], &state, nullptr);
    }
    // Hips go on from where they were seen: a millimetre of noise is little beside what comes.
    if (now > 0 && seen_[now - 1].hips.Sees(static_cast<int>(n))) {
      const Vector3<double> off = Scaled(seen_[now - 1].hips.hip[n] - rollout[n][now]);
      for (int i = 0; i < 3; ++i) state[i].position = off[i];
    }
    HipPath path;
    for (int t = observed_; t < frames_; ++t) {
      const double reach = process_[n].Reach(t - now);
      Vector3<double> left;
      for (int i = 0; i < 3; ++i) {
        left[i] = unit_ * kAxisScale[i] * (state[i].position + reach * state[i].velocity);
      }
      path.push_back(rollout[n][t] + axes_ * left);
    }
    forecast.push_back(std::move(path));
  }
  return forecast;
}

std::vector<std::vector<MixturePoint>> RecordingFilter::Mixture(
    const RecordingEffect& effect, std::vector<double>* weights) const {
  *weights =
      acts() ? EffectWeights(misfit_, effect.spread, effect.error_scale) : std::vector<double>{1.0};
  std::vector<std::vector<MixturePoint>> mixture(process_.size());
  for (size_t n = 0; n < process_.size(); ++n) {
    const std::vector<double> variances = process_[n].VariancesAhead(frames_ - observed_);
    for (int t = observed_; t < frames_; ++t) {
      const double reach = process_[n].Reach(t - observed_ + 1);
      MixturePoint point;
      point.deviation =
          effect.error_scale * unit_ * std::sqrt(variances[t - observed_]) * kAxisScale;
      for (const Node& node : nodes_) {
        if (node.hip.empty()) {
          point.mean.push_back(Vector3<double>::Zero());  // of no weight
          continue;
        }
        Vector3<double> error;
        for (int i = 0; i < 3; ++i) {
          const ErrorProcess::State& now = node.error[n][i];
          error[i] = now.position + reach * now.velocity;
        }
        point.mean.push_back(axes_.transpose() * node.hip[n][t] +
                             unit_ * kAxisScale.cwiseProduct(error));
      }
      mixture[n].push_back(std::move(point));
    }
  }
  return mixture;
}

namespace {

constexpr double kReferenceTime = 31.0 / 60.0;  // s, where var p = 1
constexpr double kNoise = 0.05;                 // of y, on that scale

}  // namespace

ErrorProcess::ErrorProcess(double dt) : dt_(dt), decay_(std::exp(-dt / kErrorTime)) {
  drive_ = 1.0 - decay_ * decay_;
  Covariance at;
  const long frames = std::max(1L, std::lround(kReferenceTime / dt));
  for (long t = 0; t < frames; ++t) at = Advanced(at);
  drive_ /= at.pp;
}

ErrorProcess::Covariance ErrorProcess::Advanced(const Covariance& now) const {
  const double vv = decay_ * decay_ * now.vv + drive_;
  const double pv = decay_ * now.pv;  // of p_t-1 and v_t
  return {now.pp + 2.0 * dt_ * pv + dt_ * dt_ * vv, pv + dt_ * vv, vv};
}

ErrorProcess::Gains ErrorProcess::Next(bool seen) {
  now_ = Advanced(now_);
  if (!seen) return {};
  const double variance = now_.pp + kNoise * kNoise;
  const Gains gains = {now_.pp / variance, now_.pv / variance, variance};
  now_ = {now_.pp - gains.position * now_.pp, now_.pv - gains.position * now_.pv,
          now_.vv - gains.velocity * now_.pv};
  return gains;
}

ErrorProcess::State ErrorProcess::Predicted(const State& state) const {
  const double velocity = decay_ * state.velocity;
  return {state.position + dt_ * velocity, velocity};
}

double ErrorProcess::Reach(int frames) const {
  return dt_ * decay_ * (1.0 - std::pow(decay_, frames)) / (1.0 - decay_);  // r + ... + r^frames
}

std::vector<double> ErrorProcess::VariancesAhead(int frames) const {
  std::vector<double> variances;
  Covariance at = now_;
  for (int t = 0; t < frames; ++t) {
    at = Advanced(at);
    variances.push_back(at.pp + kNoise * kNoise);
  }
  return variances;
}

namespace {

// Of the reference person (self_terms.h).
void SetForecastGains(ParameterSet<double>* p) {
  for (Parameter id :
       {kMu, kMuY, kCoulombFriction, kKpX, kKpY, kKdX, kKdY, kBx, kBy, kTx, kTy, kCq, kDq}) {
    (*p)[id] = 0.0;
  }
  (*p)[kKpTheta] = (*p)[kKpPhi] = 500.0;
  (*p)[kKdTheta] = (*p)[kKdPhi] = 700.0;
  (*p)[kAx] = (*p)[kAy] = -1.5;
}

}  // namespace

SceneFilter::SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
                         const InputNoise& noise, const PendulumRecording& recording, int frames)
    : angle_(OwnAxes(recording, model.options.directions)),
      to_(angle_),
      back_(-angle_),
      filter_(SceneInOwnAxes(recording, model.options), model.options, std::move(parameters), noise,
              frames) {}

RolloutStatus SceneFilter::Observe(const std::vector<PendulumState<double>>& measured,
                                   const std::vector<bool>& seen) {
  if (angle_ == 0.0) return filter_.Observe(measured, seen);
  std::vector<PendulumState<double>> turned = measured;
  for (PendulumState<double>& state : turned) state.q = to_.Pose(state.q);
  return filter_.Observe(turned, seen);
}

PendulumState<double> SceneFilter::TurnedBack(PendulumState<double> state) const {
  if (angle_ == 0.0) return state;
  state.qd = back_.PoseJacobian(state.q) * state.qd;
  state.q = back_.Pose(state.q);
  return state;
}

RolloutStatus SceneFilter::Forecast(RolloutPath<double>* path) const {
  const RolloutStatus status = filter_.Forecast(path);
  if (angle_ == 0.0 || !status.ok) return status;
  for (int t = 0; t < path->num_frames(); ++t) {
    for (int n = 0; n < path->num_people(); ++n) path->At(t, n) = TurnedBack(path->At(t, n));
  }
  return status;
}

Vector4<double> SceneFilter::Force(int person) const {
  return back_.Force(filter_.state(person).q, filter_.Input(person));
}

Vector4<double> SceneFilter::ForceDeviation(int person) const {
  // The planes are independent; people lean little, so that torques turn as forces do.
  const Vector4<double> own = filter_.InputDeviation(person);
  const Eigen::Vector2d x = back_.Horizontal({1.0, 0.0}).cwiseAbs2();
  const Eigen::Vector2d y = back_.Horizontal({0.0, 1.0}).cwiseAbs2();
  Vector4<double> turned;
  for (int i : {0, 2}) {
    turned.segment<2>(i) = (x * own[i] * own[i] + y * own[i + 1] * own[i + 1]).cwiseSqrt();
  }
  return turned;
}

std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, const ForecastStack& stack,
                                          const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (ParameterSet<double>& p : parameters) {
    if (model.options.stance == Stance::kSlide) SetForecastGains(&p);
    ScaleTail(stack.tail_strength, &p);
    p[kTailTime] *= stack.tail_time;
  }
  return SceneFilter(model, std::move(parameters), stack.noise, recording, frames);
}

std::optional<SceneFilter> UnknownForceFilter(const IdentifiedModel& model, const InputNoise& noise,
                                              const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  return SceneFilter(model, PeoplesParameters(model, recording), noise, recording, frames);
}

}  // namespace pushid
