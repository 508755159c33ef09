// ident: four forecasters side by side.
#include "ident/observed/first_frames.h"

#include <utility>

namespace pushid {
namespace {

constexpr double kVelocityWindow = 1.0 / 60.0;  // s

}  // namespace

SeenFrame FrameAt(const PendulumRecording& recording, int frame) {
  SeenFrame seen{HipsAt(recording, frame), {}};
  for (const auto& states : recording.states) seen.states.push_back(states[frame]);
  return seen;
}

FirstFrames::FirstFrames(const IdentifiedModel& model, const ForecastStack& stack,
                         const PendulumRecording& recording, int frames)
    : recording_(&recording),
      filter_(model, recording, frames),
      input_(ForecastFilter(model, stack, recording, frames)) {
  for (const auto& hip : recording.hip) {
    paths_.push_back({{hip[0]}, {true}});
    beside_.push_back(Vector3<double>::Zero());
  }
}

void FirstFrames::Observe(SeenFrame frame) {
  if (observed() >= frames()) return;
  filter_.Observe(frame.hips);
  std::vector<bool> seen;
  for (size_t n = 0; n < paths_.size(); ++n) {
    seen.push_back(frame.hips.Sees(static_cast<int>(n)));
    paths_[n].hip.push_back(frame.hips.hip[n]);
    paths_[n].seen.push_back(seen.back());
  }
  if (input_) {
    input_->Observe(frame.states, seen);
    for (size_t n = 0; n < paths_.size(); ++n) {
      const int person = static_cast<int>(n);
      if (!seen[n] || !input_->status().ok) continue;
      beside_[n] = frame.hips.hip[n] -
                   HipPosition(recording_->scene.people[n].body, input_->State(person).q);
    }
  }
  seen_.push_back(std::move(frame));
}

std::vector<Vector3<double>> FirstFrames::LastHips() const {
  std::vector<Vector3<double>> hips;
  for (const SeenPath& path : paths_) hips.push_back(path.hip[LastSeen(path)]);
  return hips;
}

HipPaths FirstFrames::InputHips(InputForecast* forecast) const {
  HipPaths hips;
  if (!input_) return hips;
  forecast->status = input_->Forecast(&forecast->path);
  if (!forecast->status.ok) return hips;
  for (size_t n = 0; n < paths_.size(); ++n) {
    hips.emplace_back();
    for (int t = observed(); t < frames(); ++t) {
      const Vector4<double>& q = forecast->path.At(t, static_cast<int>(n)).q;
      hips.back().push_back(beside_[n] + HipPosition(recording_->scene.people[n].body, q));
    }
  }
  return hips;
}

ForecastsOfAll FirstFrames::Forecasts(const HipPaths& rollout, InputForecast* input) const {
  ForecastsOfAll all;
  const auto of = [&all](Forecaster who) -> HipPaths& { return all[static_cast<int>(who)]; };
  if (!rollout.empty()) of(Forecaster::kPhysics) = filter_.ForecastOf(rollout);
  InputForecast own;
  of(Forecaster::kInput) = InputHips(input != nullptr ? input : &own);
  const double dt = recording_->scene.dt;
  const int ahead = frames() - observed();
  for (const SeenPath& seen : paths_) {
    of(Forecaster::kKinematic).push_back(GoesOnAccelerating(seen, dt, ahead));
    of(Forecaster::kVelocity).push_back(GoesOn(seen, kVelocityWindow, dt, ahead));
  }
  return all;
}

}  // namespace pushid
