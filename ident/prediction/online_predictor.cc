// ident: rollouts corrected by the frames that were seen.
#include "ident/prediction/online_predictor.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// The cart under a hip.
Eigen::Vector2d CartUnder(const Body& body, const Vector3<double>& hip, const Vector4<double>& q) {
  Vector4<double> at_origin = q;
  at_origin.head<2>().setZero();
  return (hip - HipPosition(body, at_origin)).head<2>();
}

}  // namespace

SeenFrame FrameAt(const PendulumRecording& recording, int frame) {
  SeenFrame seen{HipsAt(recording, frame), {}};
  for (const auto& states : recording.states) seen.states.push_back(states[frame]);
  return seen;
}

MaybeError CheckLearnsFromFrames(const IdentifiedModel& model) {
  if (model.recording_effect) return std::nullopt;
  const bool tail = model.options.push_tail != PushTail::kNone;
  return Error{
      tail ? "the model has no estimate of how recordings differ, which predictions from observed "
             "frames need: it was fitted by an older version; fit it again with pushid-fit"
           : "the model has no push tail, which predictions from observed frames need: fit one "
             "with --push_tail=exponential (the presets tail and group have it)",
      model.source};
}

OnlinePredictor::OnlinePredictor(const IdentifiedModel& model, const PendulumRecording& recording,
                                 int num_frames)
    : model_(&model),
      recording_(&recording),
      filter_(std::make_unique<RecordingFilter>(model, recording, num_frames)) {}

Result<OnlinePredictor> OnlinePredictor::Make(const IdentifiedModel& model,
                                              const PendulumRecording& recording, int num_frames) {
  if (MaybeError error = CheckLearnsFromFrames(model)) return *error;
  OnlinePredictor predictor(model, recording, num_frames);
  if (predictor.filter_->ok()) return Result<OnlinePredictor>(std::move(predictor));
  return Error{"recording " + recording.id +
               ": people leave the model's domain with any push tail"};
}

void OnlinePredictor::Observe(SeenFrame frame) {
  if (observed() >= filter_->frames()) return;
  filter_->Observe(frame.hips);
  seen_.push_back(std::move(frame));
}

EffectEstimate OnlinePredictor::effect() const {
  return filter_->Effect(*model_->recording_effect);
}

Prediction OnlinePredictor::Predict() const {
  const int frames = filter_->frames(), from = observed();
  Prediction prediction = pushid::Predict(*model_, *recording_, frames, effect().mean);
  prediction.observed = from;
  prediction.effect = effect();
  if (!prediction.status.ok || from == 1) return prediction;
  const HipPaths hips = filter_->ForecastOf(prediction.hip)
                            .Blended(model_->recording_effect->Blend(filter_->seconds()));
  const double dt = recording_->scene.dt;
  for (size_t n = 0; n < hips.size(); ++n) {
    const int person = static_cast<int>(n);
    const Vector4<double> off = seen_.back().states[n].q - prediction.path.At(from - 1, person).q;
    for (int t = 1; t < frames; ++t) {
      PendulumState<double>& state = prediction.path.At(t, person);
      Vector3<double>& hip = prediction.hip[n][t];
      if (t < from) {
        state.q = seen_[t - 1].states[n].q;
        state.qd = seen_[t - 1].states[n].qd;
        hip = seen_[t - 1].hips.hip[n];
        continue;
      }
      hip = hips[n][t - from];
      state.q.tail<2>() += std::exp(-(t - from + 1) * dt / kErrorTime) * off.tail<2>();
      state.q.head<2>() = CartUnder(prediction.BodyAt(recording_->scene, t, person), hip, state.q);
      state.qd = (state.q - prediction.path.At(t - 1, person).q) / dt;
    }
  }
  return prediction;
}

HipDistribution OnlinePredictor::Distribution(const Prediction& prediction) const {
  HipPaths centre;
  for (const HipPath& hip : prediction.hip)
    centre.emplace_back(hip.begin() + observed(), hip.end());
  return HipDistribution(*filter_, *model_->recording_effect, centre);
}

namespace {

// A predictor that has seen the first frames.
Result<OnlinePredictor> After(const IdentifiedModel& model, const PendulumRecording& recording,
                              int observed, int num_frames) {
  Result<OnlinePredictor> made =
      OnlinePredictor::Make(model, recording, num_frames > 0 ? num_frames : recording.num_frames());
  for (int t = 1; made.ok() && t < observed; ++t) made.value().Observe(FrameAt(recording, t));
  return made;
}

}  // namespace

Result<Prediction> PredictFrom(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed, int num_frames) {
  if (observed == 0) return Predict(model, recording, num_frames);
  const Result<OnlinePredictor> made = After(model, recording, observed, num_frames);
  if (!made.ok()) return made.error();
  Prediction prediction = made.value().Predict();
  if (!prediction.status.ok) return prediction;
  const HipDistribution hips = made.value().Distribution(prediction);
  for (int n = 0; n < hips.num_people(); ++n) {
    HipBand band;
    for (int t = 0; t < hips.num_frames(); ++t) {
      band.lower90.emplace_back();
      band.upper90.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        band.lower90.back()[axis] = hips.Quantile(n, t, axis, 0.05);
        band.upper90.back()[axis] = hips.Quantile(n, t, axis, 0.95);
      }
    }
    prediction.bands.push_back(std::move(band));
  }
  return prediction;
}

Result<std::vector<HipPaths>> DrawFrom(const IdentifiedModel& model,
                                       const PendulumRecording& recording, int observed, int draws,
                                       uint64_t seed, int num_frames) {
  const Result<OnlinePredictor> made = After(model, recording, observed, num_frames);
  if (!made.ok()) return made.error();
  const Prediction prediction = made.value().Predict();
  if (!prediction.status.ok) return Error{OutsideText(prediction.status)};
  const HipDistribution hips = made.value().Distribution(prediction);
  Random random(seed);
  std::vector<HipPaths> futures;
  for (int i = 0; i < draws; ++i) {
    HipPaths future = hips.Draw(&random);
    for (size_t n = 0; n < future.size(); ++n) {
      const HipPath& seen = prediction.hip[n];
      future[n].insert(future[n].begin(), seen.begin(), seen.begin() + observed);
    }
    futures.push_back(std::move(future));
  }
  return futures;
}

std::string EffectText(const Prediction& prediction) {
  if (prediction.observed == 0 || prediction.effect.error == 0.0) return "";
  const EffectEstimate& b = prediction.effect;
  return "tail " + Rounded(std::exp(b.mean), 3) + " times that of the mean recording (b " +
         Rounded(b.mean, 2) + " +- " + Rounded(b.error, 2) + "), from " +
         std::to_string(prediction.observed) + " frame" + (prediction.observed == 1 ? "" : "s") +
         "\n";
}

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
