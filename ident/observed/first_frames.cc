// ident: four forecasters side by side.
#include "ident/observed/first_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/decompositions.h"

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

namespace {

constexpr double kWindow = 14.0 / 60.0, kFading = 0.25, kDrag = 1.0;  // s, s and 1/s

struct Motion {
  Vector3<double> place, velocity, acceleration;
};

// At the last frame that was seen.
Motion FittedMotion(const SeenPath& path, int last, double dt) {
  const int window = std::max(3, static_cast<int>(std::lround(kWindow / dt)));
  std::vector<int> frames;
  for (int t = std::max(0, last - window + 1); t <= last; ++t) {
    if (path.seen[t] || t == 0) frames.push_back(t);
  }
  Motion motion{path.hip[last], Vector3<double>::Zero(), Vector3<double>::Zero()};
  const int order = std::min<int>(3, static_cast<int>(frames.size()));
  if (order < 2) return motion;
  Eigen::MatrixXd powers(frames.size(), order), places(frames.size(), 3);
  for (size_t i = 0; i < frames.size(); ++i) {
    const double s = (frames[i] - last) * dt;
    for (int j = 0; j < order; ++j) powers(i, j) = j == 0 ? 1.0 : j == 1 ? s : 0.5 * s * s;
    places.row(i) = path.hip[frames[i]].transpose();
  }
  const Eigen::MatrixXd fitted = SolveSymmetric(Eigen::MatrixXd(powers.transpose() * powers),
                                                Eigen::MatrixXd(powers.transpose() * places));
  motion.velocity = fitted.row(1).transpose();
  if (order > 2) motion.acceleration = fitted.row(2).transpose();
  return motion;
}

// frames_ahead places after the last frame there is, from a motion at an earlier one.
template <typename Step>
HipPath Continued(Motion motion, int frames_before, int frames_ahead, const Step& step) {
  HipPath ahead;
  for (int t = 0; t < frames_before + frames_ahead; ++t) {
    step(&motion);
    if (t >= frames_before) ahead.push_back(motion.place);
  }
  return ahead;
}

}  // namespace

int LastSeen(const SeenPath& path) {
  int last = static_cast<int>(path.hip.size()) - 1;
  while (last > 0 && !path.seen[last]) --last;
  return last;
}

HipPath GoesOn(const SeenPath& path, double seconds, double dt, int frames_ahead) {
  const int last = LastSeen(path);
  int before = std::max(0, last - std::max(1, static_cast<int>(std::lround(seconds / dt))));
  while (before > 0 && !path.seen[before]) --before;
  Motion motion{path.hip[last], Vector3<double>::Zero(), Vector3<double>::Zero()};
  if (last > before) motion.velocity = (path.hip[last] - path.hip[before]) / ((last - before) * dt);
  return Continued(motion, static_cast<int>(path.hip.size()) - 1 - last, frames_ahead,
                   [dt](Motion* m) { m->place += dt * m->velocity; });
}

HipPath GoesOnAccelerating(const SeenPath& path, double dt, int frames_ahead) {
  const int last = LastSeen(path);
  return Continued(FittedMotion(path, last, dt), static_cast<int>(path.hip.size()) - 1 - last,
                   frames_ahead, [dt](Motion* m) {
                     m->velocity += dt * (m->acceleration - kDrag * m->velocity);
                     m->acceleration *= std::exp(-dt / kFading);
                     m->place += dt * m->velocity;
                   });
}

}  // namespace pushid
