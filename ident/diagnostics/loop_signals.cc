// ident: series of what moves people and of how they answer.
#include <algorithm>
#include <cmath>

#include "ident/diagnostics/spectra.h"
#include "models/net_force.h"

namespace pushid {
namespace {

// Of a recording, the parts in which the input has to have a tenth of its spread.
constexpr int kParts = 5, kMostParts = 4;
constexpr double kLeastPart = 0.1;
constexpr double kActiveShare = 0.5;         // of the frames, in which a push acts
constexpr double kLeastAcceleration = 1e-3;  // m/s^2, root mean square

double RootMeanSquare(const std::vector<double>& series) {
  double sum = 0.0;
  for (double value : series) sum += value * value;
  return series.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(series.size()));
}

// What is not there at rest: less its mean.
double Spread(std::vector<double> series) {
  double mean = 0.0;
  for (double value : series) mean += value / static_cast<double>(series.size());
  for (double& value : series) value -= mean;
  return RootMeanSquare(series);
}

// Whether it goes on: in most parts of the recording, not in one as a step does.
bool GoesOn(const std::vector<double>& series) {
  const size_t part = series.size() / kParts;
  if (part < 2) return false;
  const double whole = Spread(series);
  int moving = 0;
  for (int i = 0; i < kParts; ++i) {
    const auto from = series.begin() + static_cast<std::ptrdiff_t>(i * part);
    const std::vector<double> own(from, from + static_cast<std::ptrdiff_t>(part));
    moving += Spread(own) > kLeastPart * whole;
  }
  return moving >= kMostParts;
}

std::vector<double> GroundSeries(const GroundMotion& ground, int row, int frames) {
  std::vector<double> series;
  for (int t = 0; t < frames; ++t) series.push_back(ground.PoseAt(t)[row]);
  return series;
}

std::vector<double> SecondDifference(const std::vector<double>& series, double dt) {
  std::vector<double> second;
  for (size_t t = 1; t + 1 < series.size(); ++t) {
    second.push_back((series[t + 1] - 2.0 * series[t] + series[t - 1]) / (dt * dt));
  }
  return second;
}

struct Pushing {
  std::vector<double> force, torque;
  int active = 0;  // frames
};

// By external pushes: those of other kinds stand for what the ground does as well.
Pushing PushingOf(const PendulumRecording& recording, int person, int plane) {
  Pushing pushing;
  for (int t = 0; t < recording.num_frames(); ++t) {
    Vector4<double> sum = Vector4<double>::Zero();
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.person != person || !push.Active(t) || push.kind != PushKind::kExternal) continue;
      sum += push.force[t - push.start_frame];
    }
    pushing.force.push_back(sum[plane]);
    pushing.torque.push_back(sum[2 + plane]);
    pushing.active += !sum.isZero(0.0);
  }
  return pushing;
}

// What was not seen is taken as it was before.
void Hold(std::vector<double>* series) {
  series->push_back(series->empty() ? 0.0 : series->back());
}

// The ankles' torque by platforms, less that at rest (head comment).
std::vector<double> TorqueByPlates(const PendulumRecording& recording, int person, int plane) {
  std::vector<double> torque;
  const Body& body = recording.scene.people[person].body;
  const GroundMotion& ground = recording.scene.ground;
  const double place = recording.states[person][0].q[plane];
  for (int t = 0; t < recording.num_frames(); ++t) {
    const PlateFrame& frame = recording.plates[person][t];
    if (frame.weight <= 0.0 || recording.Weight(person, t) <= 0.0) {
      Hold(&torque);
      continue;
    }
    const double g = ground.StepAt(t).gravity;
    const double arm = frame.centre[plane] - (recording.states[person][t].q[plane] - place);
    const double sum = body.mass * g * arm + body.cart_height * frame.shear[plane];
    torque.push_back(plane == 0 ? -sum : sum);
  }
  return torque;
}

std::vector<double> TorqueByMotion(const PendulumRecording& recording, int person, int plane,
                                   const ModelOptions& options, const ParameterSet<double>& p) {
  const Scene& scene = recording.scene;
  const BodyOf<double> body =
      DynamicBody<double>(options, scene.people[person].body, p, options.stance == Stance::kFixed);
  std::vector<double> torque;
  for (int t = 0; t + 1 < recording.num_frames(); ++t) {
    // Of an acceleration three frames must be known.
    if (std::min({recording.Weight(person, std::max(t - 1, 0)), recording.Weight(person, t),
                  recording.Weight(person, t + 1)}) <= 0.0) {
      Hold(&torque);
      continue;
    }
    const PendulumState<double>& state = recording.states[person][t];
    const GroundStep& ground = scene.ground.StepAt(t);
    Vector4<double> push = PushForceAt(scene, person, t);
    if (options.body == BodyModel::kTable) push *= p[kPushGain];
    const Vector4<double> a =
        (recording.states[person][t + 1].qd - state.qd) / scene.dt + ground.acceleration;
    const Vector4<double> more =
        (ground.gravity / kGravity - 1.0) * Gravity(body, Angles<double>(state.q)) - push;
    torque.push_back((InverseDynamics(body, state, a) + more)[2 + plane]);
  }
  Hold(&torque);
  return torque;
}

std::vector<double> AngleInLaboratory(const PendulumRecording& recording, int person, int plane) {
  const Vector3<double> origin = Vector3<double>::Zero();  // angles do not ask for it
  std::vector<double> angle;
  for (int t = 0; t < recording.num_frames(); ++t) {
    if (recording.Weight(person, t) <= 0.0) {
      Hold(&angle);
      continue;
    }
    const PendulumState<double>& state = recording.states[person][t];
    angle.push_back(InLaboratory(recording.scene.ground, t, origin, state).q[2 + plane]);
  }
  return angle;
}

}  // namespace

std::optional<ContinuousInput> ContinuousInputOf(const PendulumRecording& recording) {
  std::optional<ContinuousInput> best;
  double most = kLeastAcceleration;
  const int frames = recording.num_frames();
  const auto offer = [&](double acceleration, ContinuousInput input) {
    if (acceleration <= most || !GoesOn(input.series)) return;
    most = acceleration;
    best = std::move(input);
  };
  const GroundMotion& ground = recording.scene.ground;
  for (int plane = 0; plane < 2; ++plane) {
    if (ground.moves()) {
      std::vector<double> shift = GroundSeries(ground, plane, frames);
      const double by_shift = RootMeanSquare(SecondDifference(shift, recording.scene.dt));
      offer(by_shift, {Disturbance::kGroundShift, plane, 0, 0.0, std::move(shift)});
      std::vector<double> tilt = GroundSeries(ground, 2 + plane, frames);
      const double by_tilt = kGravity * Spread(tilt);
      offer(by_tilt, {Disturbance::kGroundTilt, plane, 0, 0.0, std::move(tilt)});
    }
    for (int n = 0; n < recording.num_people(); ++n) {
      Pushing pushing = PushingOf(recording, n, plane);
      if (pushing.active < kActiveShare * frames) continue;
      double both = 0.0, square = 0.0;
      for (int t = 0; t < frames; ++t) {
        both += pushing.force[t] * pushing.torque[t];
        square += pushing.force[t] * pushing.force[t];
      }
      const double by_force = Spread(pushing.force) / recording.scene.people[n].body.mass;
      const double lever = square > 0.0 ? both / square : 0.0;
      offer(by_force, {Disturbance::kForce, plane, n, lever, std::move(pushing.force)});
    }
  }
  return best;
}

std::vector<double> OutputSeries(const PendulumRecording& recording, int person, int plane,
                                 LoopOutput output, const ModelOptions& options,
                                 const ParameterSet<double>& p) {
  if (output == LoopOutput::kAngle) return AngleInLaboratory(recording, person, plane);
  if (recording.HasPlates(person)) return TorqueByPlates(recording, person, plane);
  return TorqueByMotion(recording, person, plane, options, p);
}

}  // namespace pushid
