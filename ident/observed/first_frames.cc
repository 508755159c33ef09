#include "ident/observed/first_frames.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "ident/problem/own_axes.h"
#include "ident/problem/parallel.h"
#include "models/decompositions.h"

namespace pushid {

Eigen::Matrix3d PushAxes(const PendulumRecording& recording) {
  const Eigen::Vector2d along = PushDirection(recording);
  Eigen::Matrix3d axes;
  axes << along.x(), -along.y(), 0.0, along.y(), along.x(), 0.0, 0.0, 0.0, 1.0;
  return axes;
}

namespace {

constexpr double kForceTime = 0.06;  // s, in which the unknown force dies out

// The filter that forecasts, its tail so much stronger and longer than the model's; none of models
// with networks, whose memory no measurement corrects.
std::optional<SceneFilter> ForecastFilter(const IdentifiedModel& model, double tail,
                                          const PendulumRecording& recording) {
  if (model.options.learned != nullptr) return std::nullopt;
  std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (ParameterSet<double>& p : parameters) {
    if (model.options.stance == Stance::kSlide) {  // gains of the reference person (self_terms.h)
      for (Parameter id :
           {kMu, kMuY, kCoulombFriction, kKpX, kKpY, kKdX, kKdY, kBx, kBy, kTx, kTy, kCq, kDq}) {
        p[id] = 0.0;
      }
      p[kKpTheta] = p[kKpPhi] = 500.0;
      p[kKdTheta] = p[kKdPhi] = 700.0;
      p[kAx] = p[kAy] = -1.5;
    }
    ScaleTail(tail, &p);
    p[kTailTime] *= tail;
  }
  InputNoise noise;
  noise.force_time = kForceTime;
  return SceneFilter(model, std::move(parameters), noise, recording);
}

constexpr double kErrorWindow = 0.05;  // s, of which an error of velocity is the mean

constexpr double kPhysicsAlone = 0.25 - 1e-9;  // s
constexpr double kSeconds = 0.35, kAhead = 0.5, kLeastSeconds = 0.05, kLeastSpeed = 0.05;
constexpr int kNumShares = static_cast<int>(std::size(kErrorShares));
constexpr double kNormal[] = {0.0627, 0.1257, 0.1891, 0.2533, 0.3186, 0.3853, 0.4538,
                              0.5244, 0.5978, 0.6745, 0.7554, 0.8416, 0.9346, 1.0364,
                              1.1503, 1.2816, 1.4395, 1.6449, 1.9600, 2.5758};

// The fall of the logarithm of the share above between the last two quantiles.
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

// s after frame 0.
constexpr double kMoments[] = {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr int kFramesAfter = 5;                                 // at least
constexpr double kInputTimes[] = {0.15, 0.0, 0.075, 0.3, 0.6};  // s; of equal ones the first
constexpr double kLeastError = 1e-3;                            // m
constexpr size_t kFewestErrors = 100;

std::vector<ForecastTrial> TrialsOf(const IdentifiedModel& model,
                                    const PendulumRecording& recording) {
  std::vector<ForecastTrial> trials;
  const int frames = recording.num_frames();
  for (size_t i = 0; i < std::size(kTails); ++i) {
    FirstFrames first(model, kTails[i], recording);
    size_t moment = 0;
    for (int t = 0; t + kFramesAfter < frames && moment < std::size(kMoments); ++t) {
      if (t > 0) first.Observe(FrameAt(recording, t));
      if (first.seconds() < kMoments[moment] - 1e-9) continue;
      TwoForecasts two = first.Forecasts(frames - 1 - t, i == 0);
      if (i == 0) {
        ForecastTrial& trial = trials.emplace_back();
        trial.seconds = first.seconds();
        trial.dt = recording.scene.dt;
        trial.axes = PushAxes(recording);
        trial.physics = std::move(two.physics);
        trial.from = first.LastHips();
        for (int n = 0; n < recording.num_people(); ++n) {
          trial.measured.emplace_back(recording.hip[n].begin() + t + 1, recording.hip[n].end());
          trial.seen.emplace_back();
          for (int u = t + 1; u < frames; ++u)
            trial.seen[n].push_back(recording.Weight(n, u) > 0.0);
        }
      }
      trials[moment++].input[i] = std::move(two.input);
    }
  }
  return trials;
}

HipPaths BlendedBy(const ForecastRule& rule, const ForecastTrial& trial) {
  const size_t tail = std::find(std::begin(kTails), std::end(kTails), rule.tail) - kTails;
  const HipPaths& input = trial.input[tail];
  const auto share = InputShare(rule.input_time, trial.physics, input, trial.seconds);
  return share ? Blended(*share, trial.physics, input) : HipPaths();
}

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

// The mean distance over people and frames that were seen; none where there are none.
std::optional<double> MeanDistance(const ForecastTrial& trial, const HipPaths& hips) {
  double sum = 0.0, count = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 0; t < hips[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      sum += (hips[n][t] - trial.measured[n][t]).norm();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional<double>(sum / count) : std::nullopt;
}

}  // namespace

SceneFilter::SceneFilter(const IdentifiedModel& model, std::vector<ParameterSet<double>> parameters,
                         const std::optional<InputNoise>& noise, const PendulumRecording& recording)
    : angle_(OwnAxes(recording, model.options.directions)),
      to_(angle_),
      back_(-angle_),
      filter_(SceneInOwnAxes(recording, model.options), model.options, std::move(parameters),
              noise) {}

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

void SceneFilter::Push(int person, const Vector4<double>& force) {
  filter_.Push(person, angle_ == 0.0 ? force : to_.Force(State(person).q, force));
}

RolloutStatus SceneFilter::Forecast(int ahead, RolloutPath<double>* path) const {
  const RolloutStatus status = filter_.Forecast(ahead, path);
  if (angle_ == 0.0 || !status.ok) return status;
  for (int t = 0; t < path->num_frames(); ++t) {
    for (int n = 0; n < path->num_people(); ++n) path->At(t, n) = TurnedBack(path->At(t, n));
  }
  return status;
}

SeenFrame FrameAt(const PendulumRecording& recording, int frame) {
  SeenFrame seen;
  for (int n = 0; n < recording.num_people(); ++n) {
    seen.hip.push_back(recording.hip[n][frame]);
    seen.states.push_back(recording.states[n][frame]);
    seen.seen.push_back(recording.Weight(n, frame) > 0.0);
  }
  return seen;
}

FirstFrames::FirstFrames(const IdentifiedModel& model, double tail,
                         const PendulumRecording& recording)
    : recording_(&recording),
      rod_moves_(RodMoves(model.options)),
      plain_(model, PeoplesParameters(model, recording), std::nullopt, recording),
      input_(ForecastFilter(model, tail, recording)),
      beside_(recording.hip.size(), Vector3<double>::Zero()) {
  for (const HipPath& hip : recording.hip) {
    seen_.push_back({{0, hip[0], Vector3<double>::Zero()}});
  }
}

double FirstFrames::seconds() const { return (observed() - 1) * recording_->scene.dt; }

Vector3<double> FirstFrames::Hip(int person, const PendulumState<double>& state) const {
  const Body& body = recording_->scene.people[person].body;
  return HipPosition(rod_moves_ ? BodyNow(body, state.rod) : body, state.q);
}

void FirstFrames::Push(int person, const Vector4<double>& force) {
  plain_.Push(person, force);
  if (input_) input_->Push(person, force);
}

void FirstFrames::Observe(const SeenFrame& frame) {
  const int now = observed_++;
  const int window =
      std::max(1, static_cast<int>(std::lround(kErrorWindow / recording_->scene.dt)));
  std::vector<bool> seen;
  for (int n = 0; n < recording_->num_people(); ++n) seen.push_back(frame.Sees(n));
  plain_.Observe(frame.states, seen);
  if (input_) input_->Observe(frame.states, seen);
  for (int n = 0; n < recording_->num_people(); ++n) {
    if (!seen[n]) continue;
    std::deque<SeenHip>& hips = seen_[n];
    hips.push_back({now, frame.hip[n], frame.hip[n] - Hip(n, plain_.State(n))});
    while (hips[1].frame <= now - window) hips.pop_front();
    if (!input_ || !input_->status().ok) continue;
    beside_[n] = frame.hip[n] - HipPosition(recording_->scene.people[n].body, input_->State(n).q);
  }
}

std::vector<Vector3<double>> FirstFrames::LastHips() const {
  std::vector<Vector3<double>> hips;
  for (const std::deque<SeenHip>& of_one : seen_) hips.push_back(of_one.back().hip);
  return hips;
}

HipPath FirstFrames::Physics(int person, const RolloutPath<double>& rollout) const {
  const double dt = recording_->scene.dt;
  const SeenHip &before = seen_[person].front(), &last = seen_[person].back();
  Vector3<double> velocity = Vector3<double>::Zero();
  if (last.frame > before.frame) {
    velocity = (last.error - before.error) / ((last.frame - before.frame) * dt);
  }
  HipPath path;
  for (int t = 1; t < rollout.num_frames(); ++t) {
    const double ahead = (observed() - 1 + t - last.frame) * dt;
    const double reach = kErrorTime * (1.0 - std::exp(-ahead / kErrorTime));
    path.push_back(Hip(person, rollout.At(t, person)) + last.error + reach * velocity);
  }
  return path;
}

TwoForecasts FirstFrames::Forecasts(int ahead, bool physics) const {
  TwoForecasts two;
  RolloutPath<double> rollout;
  if (physics) two.physics_status = plain_.Forecast(ahead, &rollout);
  for (int n = 0; physics && two.physics_status.ok && n < recording_->num_people(); ++n) {
    two.physics.push_back(Physics(n, rollout));
  }
  if (!input_) return two;
  two.input_status = input_->Forecast(ahead, &two.input_path);
  if (!two.input_status.ok) return two;
  for (size_t n = 0; n < beside_.size(); ++n) {
    HipPath& hips = two.input.emplace_back();
    for (int t = 1; t <= ahead; ++t) {
      const Vector4<double>& q = two.input_path.At(t, static_cast<int>(n)).q;
      hips.push_back(beside_[n] + HipPosition(recording_->scene.people[n].body, q));
    }
  }
  return two;
}

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
    quantiles_[i] = errors[nearest].quantiles;
    if (static_cast<int>(quantiles_[i].size()) != kNumShares) {
      quantiles_[i].assign(std::begin(kNormal), std::end(kNormal));
    }
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

ForecastRule LearnRule(const std::vector<ForecastTrial>& trials, int left_out) {
  ForecastRule best;
  double least = HUGE_VAL;
  for (double tail : kTails) {
    for (double time : kInputTimes) {
      ForecastRule rule;
      rule.tail = tail, rule.input_time = time;
      double sum = 0.0;
      for (const ForecastTrial& trial : trials) {
        if (trial.fold != left_out)
          sum += MeanDistance(trial, BlendedBy(rule, trial)).value_or(0.0);
      }
      if (sum < least) least = sum, best = rule;
    }
  }
  return best;
}

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

std::optional<ForecastRule> LearnForecasts(const IdentifiedModel& model,
                                           const std::vector<PendulumRecording>& recordings,
                                           const std::vector<FoldModel>& folds, int num_threads) {
  // The models that forecast: those of the folds, or the model itself.
  std::vector<FoldModel> forecasters = folds;
  if (folds.empty()) {
    forecasters.push_back({model, std::vector<int>(recordings.size())});
    std::iota(forecasters[0].held_out.begin(), forecasters[0].held_out.end(), 0);
  }
  std::vector<ForecastTrial> trials;
  for (size_t f = 0; f < forecasters.size(); ++f) {
    const FoldModel& fold = forecasters[f];
    std::vector<std::vector<ForecastTrial>> made(fold.held_out.size());
    ParallelFor(static_cast<int>(made.size()), num_threads, [&](int i) {
      made[i] = TrialsOf(fold.model, recordings[fold.held_out[i]]);
      for (ForecastTrial& trial : made[i]) {
        trial.fold = static_cast<int>(f), trial.recording = fold.held_out[i];
      }
    });
    for (auto& of_recording : made) {
      for (ForecastTrial& trial : of_recording) {
        if (!trial.physics.empty() || !trial.input[0].empty()) trials.push_back(std::move(trial));
      }
    }
  }
  if (trials.empty()) return std::nullopt;
  ForecastRule rule = folds.empty() ? ForecastRule() : LearnRule(trials);
  std::set<int> forecast;
  for (const ForecastTrial& trial : trials) forecast.insert(trial.recording);
  rule.folds = static_cast<int>(folds.size());
  rule.recordings = static_cast<int>(forecast.size());
  // Every fold's forecasts by a rule that was learned without it.
  std::vector<HipPaths> centre(trials.size());
  for (int f = 0; f < std::max(1, rule.folds); ++f) {
    const ForecastRule without = rule.folds > 0 ? LearnRule(trials, f) : ForecastRule();
    for (size_t i = 0; i < trials.size(); ++i) {
      if (trials[i].fold == f) centre[i] = BlendedBy(without, trials[i]);
    }
  }
  rule.errors = LearnErrorScales(trials, centre);
  return rule;
}

}  // namespace pushid
