#include "ident/prediction/online_predictor.h"

#include <cmath>

namespace pushid {
namespace {

// The cart under a hip.
Eigen::Vector2d CartUnder(const Body& body, const Vector3<double>& hip, const Vector4<double>& q) {
  Vector4<double> at_origin = q;
  at_origin.head<2>().setZero();
  return (hip - HipPosition(body, at_origin)).head<2>();
}

}  // namespace

MaybeError CheckLearnsFromFrames(const IdentifiedModel& model) {
  if (model.forecasts) return std::nullopt;
  return Error{
      "the model has learned no forecasts, which predictions from observed frames need: add them "
      "with pushid-check --learn_forecasts",
      model.source};
}

OnlinePredictor::OnlinePredictor(const IdentifiedModel& model, const PendulumRecording& recording,
                                 int num_frames, ForecastUse use)
    : model_(&model),
      recording_(&recording),
      use_(use),
      num_frames_(num_frames),
      off_(recording.num_people(), Eigen::Vector2d::Zero()),
      frames_(std::make_unique<FirstFrames>(model, model.forecasts->tail, recording)) {
  if (num_frames != kEndless) rollout_ = pushid::Predict(model, recording, num_frames);
}

Result<OnlinePredictor> OnlinePredictor::Make(const IdentifiedModel& model,
                                              const PendulumRecording& recording, int num_frames,
                                              ForecastUse use) {
  if (MaybeError error = CheckLearnsFromFrames(model)) return *error;
  OnlinePredictor predictor(model, recording, num_frames, use);
  if (use == ForecastUse::kInput && !predictor.frames_->HasInput()) {
    return Error{
        "the model has a network, whose memory no measurement corrects: there is no filter of "
        "unknown forces; leave --forecast=input out",
        model.source};
  }
  return Result<OnlinePredictor>(std::move(predictor));
}

void OnlinePredictor::Observe(const SeenFrame& frame) {
  const int t = observed();
  if (num_frames_ != kEndless && t >= num_frames_) return;
  frames_->Observe(frame);
  if (num_frames_ == kEndless || !rollout_.status.ok) return;
  for (int n = 0; n < recording_->num_people(); ++n) {
    PendulumState<double>& state = rollout_.path.At(t, n);
    off_[n].setZero();
    if (frame.Sees(n)) off_[n] = (frame.states[n].q - state.q).tail<2>();
    state.q = frame.states[n].q;
    state.qd = frame.states[n].qd;
    rollout_.hip[n][t] = frame.hip[n];
  }
}

std::optional<double> OnlinePredictor::Share(const TwoForecasts& two) const {
  return InputShare(model_->forecasts->input_time, two.physics, two.input, frames_->seconds(),
                    use_);
}

HipPaths OnlinePredictor::Next(int ahead) const {
  const TwoForecasts two = frames_->Forecasts(ahead);
  const std::optional<double> share = Share(two);
  return share ? Blended(*share, two.physics, two.input) : HipPaths();
}

void OnlinePredictor::SetForecast(const TwoForecasts& two, double input_share,
                                  Prediction* prediction) const {
  const HipPaths hips = Blended(input_share, two.physics, two.input);
  const int from = observed();
  const double dt = recording_->scene.dt;
  for (int n = 0; n < recording_->num_people(); ++n) {
    for (int t = from; t < num_frames_; ++t) {
      PendulumState<double>& state = prediction->path.At(t, n);
      Vector3<double>& hip = prediction->hip[n][t];
      hip = hips[n][t - from];
      // The rollout's lean, to which it comes back as an error of velocity dies out, and the
      // filter's.
      state.q.tail<2>() += std::exp(-(t - from + 1) * dt / kErrorTime) * off_[n];
      if (input_share > 0.0) {
        state.q.tail<2>() +=
            input_share * (two.input_path.At(t - from + 1, n).q - state.q).tail<2>();
      }
      state.q.head<2>() = CartUnder(prediction->BodyAt(recording_->scene, t, n), hip, state.q);
      state.qd = (state.q - prediction->path.At(t - 1, n).q) / dt;
    }
  }
}

Prediction OnlinePredictor::Predict() const {
  Prediction prediction = rollout_;
  prediction.observed = observed();
  if (!prediction.status.ok || observed() == 1 || num_frames_ == kEndless) return prediction;
  const TwoForecasts two = frames_->Forecasts(num_frames_ - observed());
  const std::optional<double> share = Share(two);
  if (!share) {
    const bool input = use_ == ForecastUse::kInput || two.physics_status.ok;
    prediction.status = input ? two.input_status : two.physics_status;
    prediction.hip.clear();
    return prediction;
  }
  SetForecast(two, *share, &prediction);
  return prediction;
}

HipDistribution OnlinePredictor::Distribution(const Prediction& prediction) const {
  HipPaths centre;
  for (const HipPath& hip : prediction.hip) {
    centre.emplace_back(hip.begin() + observed(), hip.end());
  }
  return HipDistribution(model_->forecasts->errors, PushAxes(*recording_), std::move(centre),
                         frames_->LastHips(), frames_->seconds(), recording_->scene.dt);
}

Result<Prediction> PredictFrom(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed, int num_frames, ForecastUse use) {
  if (observed == 0) return Predict(model, recording, num_frames);
  Result<OnlinePredictor> made = OnlinePredictor::Make(
      model, recording, num_frames > 0 ? num_frames : recording.num_frames(), use);
  if (!made.ok()) return made.error();
  OnlinePredictor& predictor = made.value();
  for (int t = 1; t < observed; ++t) predictor.Observe(FrameAt(recording, t));
  Prediction prediction = predictor.Predict();
  if (!prediction.status.ok) return prediction;
  const HipDistribution hips = predictor.Distribution(prediction);
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

}  // namespace pushid
