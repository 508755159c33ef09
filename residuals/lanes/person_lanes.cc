// residuals: scenes laid out in lanes, and the choice among their widths.
#include "residuals/lanes/person_lanes.h"

#include <algorithm>

#include "models/step.h"
#include "residuals/kernels/vector_kernels.h"

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

const std::vector<const PersonLanes*>& SupportedPersonLanes() {
  static const std::vector<const PersonLanes*> supported = [] {
    std::vector<const PersonLanes*> all = PUSHID_OF_WIDTHS(PersonLanesOf);
    all.resize(NumVectorWidths());
    return all;
  }();
  return supported;
}

const PersonLanes& BestPersonLanes() { return *SupportedPersonLanes().back(); }

const PersonLanes& PersonLanesFor(int people) {
  for (const PersonLanes* lanes : SupportedPersonLanes()) {
    if (lanes->lanes >= people) return *lanes;
  }
  return BestPersonLanes();
}

bool HasLanes(const Scene& scene, const ModelOptions& options) {
  return scene.num_people() == 1 && options.stance == Stance::kSlide &&
         options.learned == nullptr && options.own_laws.empty() && options.delay == Delay::kNone &&
         options.body != BodyModel::kTable && !scene.ground.moves();
}

int NumTails(const Scene& scene, const ModelOptions& options) {
  return static_cast<int>(PushesWithTails(scene, options).size());
}

void LaneParameters::Clear(int width) {
  width_ = width;
  values_.assign(kLaneParameters * width, 1.0);  // of a lane that nobody is in
  entries_.clear();
}

void LaneParameters::Set(int lane, const ParameterSet<double>& values,
                         const std::vector<ColumnEntry>& entries) {
  for (int i = 0; i < kLaneParameters; ++i) values_[i * width_ + lane] = values[i];
  size_t k = 0;
  for (const ColumnEntry& entry : entries) {
    if (entry.parameter >= kLaneParameters) continue;  // acts on people who touch
    if (k == entries_.size()) {
      entries_.push_back({entry.column, entry.parameter});
      slopes_.resize(entries_.size() * width_);
    }
    slopes_[k++ * width_ + lane] = entry.derivative;
  }
}

void LaneParameters::In(LaneInputs* in) const {
  in->parameters = values_.data();
  in->slopes = slopes_.data();
  in->entries = entries_.data();
  in->num_entries = static_cast<int>(entries_.size());
}

int NumSteps(const Scene& scene, int frames) { return std::min(frames, scene.LastPushEnd() + 1); }

LaneTables::LaneTables(const PersonLanes& lanes, int frames, int num_tails, int steps)
    : lanes_(&lanes),
      frames_(frames),
      num_tails_(num_tails),
      num_steps_(steps),
      constants_(kLaneConstants * width(), 1.0),  // of a lane that nobody is in
      steps_(steps * kLaneFields * width()),
      tails_(num_tails * kLaneTails * width()) {}

void LaneTables::Set(int lane, const Scene& scene, const ModelOptions& options, int frames) {
  friction_ = options.friction;
  cart_derivative_ = options.cart_derivative == CartDerivative::kBackward;
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

LaneInputs LaneTables::Inputs() const {
  LaneInputs in;
  in.friction = friction_;
  in.cart_derivative = cart_derivative_;
  in.frames = frames_;
  in.num_steps = num_steps_;
  in.num_tails = num_tails_;
  in.constants = constants_.data();
  in.tails = tails_.data();
  in.steps = steps_.data();
  return in;
}

void LaneTables::Roll(const LaneInputs& in, LaneSums sums, LaneOutputs out) const {
  thread_local std::vector<double> storage;  // a thread's own, used again
  storage.resize(LaneStorage(width(), in.columns, in.num_tails));
  out.storage = storage.data();
  lanes_->roll(in, sums, out);
}

}  // namespace pushid
