// residuals: scenes laid out in lanes, and the choice among their widths.
#include "residuals/lanes/person_lanes.h"

#include <algorithm>

#include "models/step.h"

namespace pushid {
namespace {

std::vector<const ScenePush*> PushesWithTails(const Scene& scene, const ModelOptions& options) {
  std::vector<const ScenePush*> pushes;
  if (options.push_tail == PushTail::kNone) return pushes;
  for (const ScenePush& push : scene.pushes) {
    if (push.person == 0 && TailActs(push, push.EndFrame())) pushes.push_back(&push);
  }
  return pushes;
}

}  // namespace

const PersonLanes& PersonLanesFor(int people) {
  for (const PersonLanes* lanes : Supported<PersonLanes>()) {
    if (lanes->lanes >= people) return *lanes;
  }
  return Widest<PersonLanes>();
}

bool HasLanes(const Scene& scene, const ModelOptions& options) {
  return scene.num_people() == 1 && options.stance == Stance::kSlide &&
         options.learned == nullptr && options.own_laws.empty() && options.delay == Delay::kNone &&
         options.cart_derivative == CartDerivative::kNone && options.body != BodyModel::kTable &&
         !scene.ground.moves();
}

int NumTails(const Scene& scene, const ModelOptions& options) {
  return static_cast<int>(PushesWithTails(scene, options).size());
}

int NumSteps(const Scene& scene, int frames) { return std::min(frames, scene.LastPushEnd() + 1); }

LaneTables::LaneTables(const PersonLanes& lanes, int num_tails, int steps)
    : lanes_(&lanes),
      num_tails_(num_tails),
      num_steps_(steps),
      constants_(kLaneConstants * width(), 1.0),  // of a lane that nobody is in
      steps_(steps * kLaneFields * width()),
      tails_(num_tails * kLaneTails * width()) {}

void LaneTables::Set(int lane, const Scene& scene, const ModelOptions& options, int frames) {
  friction_ = options.friction;
  const SelfForce self(options, scene.people[0].body, scene.people[0].start.q, scene.dt);
  Constant(kLaneMass, lane) = self.body.mass;
  Constant(kLaneRod, lane) = self.body.rod_length;
  Constant(kLaneHeight, lane) = self.body.cart_height;
  Constant(kLanePointShare, lane) = self.body.point_share;
  Constant(kLanePendulumRatio, lane) = self.body.pendulum_ratio;
  Constant(kLaneScale, lane) = self.scale.force;
  Constant(kLaneScale + 1, lane) = self.scale.stiffness;
  Constant(kLaneScale + 2, lane) = self.scale.damping;
  for (int i = 0; i < 2; ++i) {
    Constant(kLanePosture + i, lane) = self.posture[i];
    Constant(kLaneHold + i, lane) = self.hold[i];
  }
  Constant(kLaneStep, lane) = scene.dt;
  for (int i = 0; i < 4; ++i) {
    Constant(kLaneStart + i, lane) = scene.people[0].start.q[i];
    Constant(kLaneStart + 4 + i, lane) = scene.people[0].start.qd[i];
  }
  SetSteps(lane, scene, options, frames);
  SetTails(lane, scene, options);
}

void LaneTables::SetSteps(int lane, const Scene& scene, const ModelOptions& options, int frames) {
  for (int t = 0; t < std::min(frames, num_steps_); ++t) {
    double* const step = Step(lane, t);
    const ActiveForces active = ForcesAt(scene, options.push, 0, t);
    step[kLaneActs * width()] = active == ActiveForces::kAll ? 1.0 : 0.0;
    step[kLaneSlides * width()] = active == ActiveForces::kPushOnly ? 0.0 : 1.0;
    step[kLaneGoesOn * width()] = t + 1 < frames ? 1.0 : 0.0;
  }
  for (const ScenePush& push : scene.pushes) {
    if (push.person != 0) continue;
    for (int t = std::max(0, push.start_frame); t < std::min(frames, push.EndFrame()); ++t) {
      for (int i = 0; i < 4; ++i) {
        Step(lane, t)[(kLanePush + i) * width()] += push.force[t - push.start_frame][i];
      }
    }
  }
}

void LaneTables::SetMeasured(int lane, int frame, const Vector3<double>& hip,
                             const PendulumState<double>& state, double weight) {
  double* const step = Step(lane, frame);
  for (int i = 0; i < 3; ++i) step[(kLaneHip + i) * width()] = hip[i];
  for (int i = 0; i < 4; ++i) {
    step[(kLanePose + i) * width()] = state.q[i];
    step[(kLaneVelocity + i) * width()] = state.qd[i];
  }
  step[kLaneWeight * width()] = weight;
}

void LaneTables::SetTails(int lane, const Scene& scene, const ModelOptions& options) {
  double* tail = tails_.data() + lane;
  for (const ScenePush* push : PushesWithTails(scene, options)) {
    const TailOf<double> at_end =
        TailAt(*push, scene.people[0].body.mass, push->EndFrame(), scene.dt);
    for (int i = 0; i < 4; ++i) tail[(kLaneMean + i) * width()] = at_end.mean[i];
    tail[kLaneMassPerForce * width()] = at_end.mass_per_force;
    tail[kLaneLogDuration * width()] = at_end.log_duration;
    tail[kLaneEnd * width()] = push->EndFrame();
    tail += kLaneTails * width();
  }
}

void LaneTables::Roll(const LaneRequest& request, const std::vector<LanePerson>& people,
                      LaneResults* results) const {
  // A thread's own, used again.
  thread_local std::vector<double> constants, parameters, slopes, storage;
  thread_local std::vector<LaneEntry> entries;
  const int lanes = width();
  constants = constants_;
  parameters.assign(kLaneParameters * lanes, 1.0);  // of a lane that nobody is in
  entries.clear();
  for (int lane = 0; lane < static_cast<int>(people.size()); ++lane) {
    const LanePerson& person = people[lane];
    for (int i = 0; person.velocity != nullptr && i < 4; ++i) {
      constants[(kLaneStart + 4 + i) * lanes + lane] = person.velocity[i];
    }
    for (int i = 0; i < kLaneParameters; ++i) parameters[i * lanes + lane] = person.parameters[i];
    size_t k = 0;
    for (const ColumnEntry& entry : person.entries) {
      if (entry.parameter >= kLaneParameters) continue;  // acts on people who touch
      if (k == entries.size()) {
        entries.push_back({entry.column, entry.parameter});
        slopes.resize(entries.size() * lanes);
      }
      slopes[k++ * lanes + lane] = entry.derivative;
    }
  }
  LaneInputs in;
  static_cast<LaneRequest&>(in) = request;
  in.friction = friction_;
  in.num_entries = static_cast<int>(entries.size());
  in.num_tails = num_tails_;
  in.num_steps = num_steps_;
  in.entries = entries.data();
  in.slopes = slopes.data();
  in.constants = constants.data();
  in.parameters = parameters.data();
  in.tails = tails_.data();
  in.steps = steps_.data();
  const bool equations = in.sums == LaneSums::kPlain || in.sums == LaneSums::kRobust;
  const int size = equations ? (in.columns + 1) * (in.columns + 1) * lanes : 0;
  const auto room = [](std::vector<double>* values, int count) {
    values->resize(count);
    return values->data();
  };
  LaneOutputs out;
  out.failed = room(&results->failed, lanes);
  out.squares = room(&results->squares, lanes);
  out.plain = room(&results->plain, size);
  out.robust = room(&results->robust, in.sums == LaneSums::kRobust ? size : 0);
  if (in.sums == LaneSums::kNone) {
    out.residuals = room(&results->residuals, (in.frames - 1) * kFrameResiduals * lanes);
  }
  if (in.sums == LaneSums::kStates) {
    const int states = std::max(0, in.frames - in.first_state);
    out.states = room(&results->states, states * 8 * (1 + in.columns) * lanes);
  }
  out.storage = room(&storage, LaneStorage(lanes, in.columns, in.num_tails));
  lanes_->roll(in, out);
}

}  // namespace pushid
