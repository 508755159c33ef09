// ident: nodes of the effect, filtered frame by frame; spread and error scale by expectation
// maximization.
#include "ident/observed/recording_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "ident/model/push_range.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/parallel.h"
#include "ident/uncertainty/clusters.h"
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

std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, const ForecastRule& rule,
                                          const PendulumRecording& recording, int frames) {
  if (model.options.learned != nullptr) return std::nullopt;
  std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (ParameterSet<double>& p : parameters) {
    if (model.options.stance == Stance::kSlide) SetForecastGains(&p);
    ScaleTail(rule.tail_strength, &p);
    p[kTailTime] *= rule.tail_time;
  }
  return SceneFilter(model, std::move(parameters), rule.noise, recording, frames);
}

namespace {

constexpr double kFirstSpread = 0.5;
constexpr double kLeastSpread = 1e-3;  // less than this is none: all weight is on b = 0
constexpr int kMostPopulationRounds = 500;
constexpr double kSettledRound = 1e-7;

// Of one recording, all of whose frames were seen.
struct Misfits {
  std::vector<double> of_node;
  int residuals = 0;
  bool acts = false;
  double unit = 1.0;  // g
};

struct Population {
  double spread = 0.0, scale = 0.0;
};

double Least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// Those of `left_out` do not count. first_spread: where the rounds begin.
Population MostLikelyPopulation(const std::vector<Misfits>& recordings,
                                const std::vector<int>& cluster, int left_out = -1,
                                double first_spread = kFirstSpread) {
  double squares = 0.0, residuals = 0.0;
  int acting = 0;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (cluster[i] == left_out) continue;
    squares += Least(recordings[i].of_node);
    residuals += recordings[i].residuals;
    acting += recordings[i].acts;
  }
  Population p{acting > 0 ? first_spread : 0.0, std::sqrt(squares / residuals)};
  for (int round = 0; round < kMostPopulationRounds && acting > 0; ++round) {
    double spread = 0.0;
    squares = 0.0;
    for (size_t i = 0; i < recordings.size(); ++i) {
      if (cluster[i] == left_out) continue;
      const Misfits& m = recordings[i];
      if (!m.acts) {
        squares += m.of_node[0];
        continue;
      }
      const std::vector<double> weights = EffectWeights(m.of_node, p.spread, p.scale);
      for (int j = 0; j < kEffectNodes; ++j) {
        if (weights[j] == 0.0) continue;  // also where the misfit is infinite
        spread += weights[j] * EffectNode(j) * EffectNode(j);
        squares += weights[j] * m.of_node[j];
      }
    }
    const Population next{std::sqrt(spread / acting), std::sqrt(squares / residuals)};
    const bool settled = std::abs(next.spread - p.spread) < kSettledRound;
    p = next;
    if (settled) break;
  }
  return p;
}

// Leaving out one cluster after the other.
double JackknifeError(const std::vector<Misfits>& recordings, const std::vector<int>& cluster,
                      int clusters, double spread_of_all) {
  if (clusters < 2) return 0.0;
  // Nearby; but from none at all the rounds do not get away.
  const double first = std::max(spread_of_all, EffectNode(1) - EffectNode(0));
  std::vector<double> spreads;
  double mean = 0.0, squares = 0.0;
  for (int g = 0; g < clusters; ++g) {
    spreads.push_back(MostLikelyPopulation(recordings, cluster, g, first).spread);
    mean += spreads.back() / clusters;
  }
  for (double spread : spreads) squares += (spread - mean) * (spread - mean);
  return std::sqrt(squares * (clusters - 1.0) / clusters);
}

// By person, or by recording where one person alone was pushed.
std::vector<int> ClustersOfPeople(const std::vector<std::string>& people, int* count) {
  std::vector<int> clusters;
  std::map<std::string, int> index;
  for (const std::string& person : people) {
    clusters.push_back(index.emplace(person, static_cast<int>(index.size())).first->second);
  }
  *count = static_cast<int>(index.size());
  if (*count > 1) return clusters;
  std::iota(clusters.begin(), clusters.end(), 0);
  *count = static_cast<int>(people.size());
  return clusters;
}

// Of the recording alone: the node of least misfit, and from there to the bottom of the parabola
// through its neighbours.
double LikeliestEffect(const std::vector<double>& misfit) {
  const int node =
      static_cast<int>(std::min_element(misfit.begin(), misfit.end()) - misfit.begin());
  if (node == 0 || node + 1 == kEffectNodes) return EffectNode(node);
  const double left = misfit[node - 1], here = misfit[node], right = misfit[node + 1];
  const double bend = left - 2.0 * here + right;
  const double spacing = EffectNode(1) - EffectNode(0);
  const bool known = std::isfinite(bend) && bend > 0.0;
  return EffectNode(node) + (known ? 0.5 * spacing * (left - right) / bend : 0.0);
}

}  // namespace

std::vector<double> EffectWeights(const std::vector<double>& misfit, double spread,
                                  double error_scale) {
  std::vector<double> weights(misfit.size());
  const double precision = 1.0 / (std::max(spread, kLeastSpread) * std::max(spread, kLeastSpread));
  const double inverse_variance = 1.0 / (error_scale * error_scale);
  for (size_t j = 0; j < misfit.size(); ++j) {
    const double b = EffectNode(static_cast<int>(j));
    weights[j] = -0.5 * (precision * b * b + misfit[j] * inverse_variance);
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  constexpr double kNothing = -40.0;  // its exponential is below the rounding of 1
  for (double& weight : weights) {
    sum += weight = weight - most > kNothing ? std::exp(weight - most) : 0.0;
  }
  for (double& weight : weights) weight *= 1.0 / sum;
  return weights;
}

EffectEstimate MeanEffect(const std::vector<double>& weights) {
  EffectEstimate estimate;
  for (int j = 0; j < kEffectNodes; ++j) estimate.mean += weights[j] * EffectNode(j);
  double variance = 0.0;
  for (int j = 0; j < kEffectNodes; ++j) {
    const double off = EffectNode(j) - estimate.mean;
    variance += weights[j] * off * off;
  }
  estimate.error = std::sqrt(variance);
  return estimate;
}

bool EffectActs(const ModelOptions& model, const PendulumRecording& recording) {
  return model.push_tail != PushTail::kNone && recording.scene.num_people() == 1 &&
         std::any_of(recording.scene.pushes.begin(), recording.scene.pushes.end(),
                     [](const ScenePush& push) {
                       return push.kind != PushKind::kExternal && !push.force.empty();
                     });
}

namespace {

double MeanSquare(const PendulumRecording& recording, const HipPaths& hips) {
  double sum = 0.0, frames = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 1; t < hips[n].size(); ++t, ++frames) {
      sum += (recording.hip[n][t] - hips[n][t]).squaredNorm();
    }
  }
  return frames > 0.0 ? sum / frames : 0.0;
}

// What the recording's own effect leaves of the squared error, over that without; each over g^2.
struct Squares {
  double left = 0.0, without = 0.0;
};
Squares SquaresOf(const IdentifiedModel& model, const PendulumRecording& recording, double effect,
                  double unit) {
  const auto hips = HipsOfRollouts(model, recording, {effect, 0.0}, recording.num_frames());
  return {MeanSquare(recording, hips[0]) / (unit * unit),
          MeanSquare(recording, hips[1]) / (unit * unit)};
}

}  // namespace

std::optional<RecordingEffect> FitRecordingEffect(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings,
                                                  int num_threads) {
  if (model.options.push_tail == PushTail::kNone) return std::nullopt;
  const int total = static_cast<int>(recordings.size());
  std::vector<Misfits> all(total);
  ParallelFor(total, num_threads, [&](int i) {
    const PendulumRecording& recording = recordings[i];
    RecordingFilter filter(model, recording, recording.num_frames());
    if (!filter.ok()) return;
    for (int t = 1; t < recording.num_frames(); ++t) filter.Observe(HipsAt(recording, t));
    all[i] = {filter.misfit(), filter.residuals(), filter.acts(), filter.error_unit()};
  });
  std::vector<const PendulumRecording*> kept;
  std::vector<Misfits> misfits;
  std::vector<std::string> people;
  for (int i = 0; i < total; ++i) {
    if (all[i].residuals == 0) continue;
    people.push_back(recordings[i].subject_ids[recordings[i].pushed_person]);
    kept.push_back(&recordings[i]);
    misfits.push_back(std::move(all[i]));
  }
  if (kept.empty()) return std::nullopt;
  RecordingEffect effect;
  const std::vector<int> cluster = ClustersOfPeople(people, &effect.clusters);
  const Population p = MostLikelyPopulation(misfits, cluster);
  effect.spread = p.spread;
  effect.error_scale = p.scale;
  if (p.spread > 0.0)
    effect.spread_error = JackknifeError(misfits, cluster, effect.clusters, p.spread);
  Squares sum;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (!misfits[i].acts) continue;
    const PendulumRecording& r = *kept[i];
    const EffectEstimate b = MeanEffect(EffectWeights(misfits[i].of_node, p.spread, p.scale));
    effect.recordings.push_back({r.id, r.subject_ids[r.pushed_person], r.labels.condition(), b.mean,
                                 b.error, LikeliestEffect(misfits[i].of_node)});
    const Squares squares = SquaresOf(model, r, b.mean, misfits[i].unit);
    sum.left += squares.left;
    sum.without += squares.without;
  }
  effect.explained = sum.without > 0.0 ? 1.0 - sum.left / sum.without : 0.0;
  return effect;
}

}  // namespace pushid
