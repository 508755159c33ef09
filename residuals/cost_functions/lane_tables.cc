// residuals: scenes laid out in lanes.
#include "residuals/cost_functions/lane_tables.h"

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

int MostFrames(const std::vector<const RolloutProblem*>& problems) {
  int most = 0;
  for (const RolloutProblem* problem : problems) most = std::max(most, problem->horizon);
  return most;
}

int MostTails(const std::vector<const RolloutProblem*>& problems) {
  int most = 0;
  for (const RolloutProblem* problem : problems) {
    most = std::max(most, NumTails(problem->recording->scene, problem->options));
  }
  return most;
}

// Whether two have the same columns.
bool SameLanes(const RolloutProblem& a, const RolloutProblem& b) {
  return a.options.friction == b.options.friction &&
         a.options.cart_derivative == b.options.cart_derivative &&
         a.layout.first_acting == b.layout.first_acting &&
         a.layout.VelocityColumn() == b.layout.VelocityColumn() &&
         std::equal(a.map.fitted.begin(), a.map.fitted.end(), b.map.fitted.begin(),
                    b.map.fitted.end(), [](const FittedParameter& x, const FittedParameter& y) {
                      return x.parameter == y.parameter;
                    });
}

}  // namespace

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

bool HasLanes(const RolloutProblem& problem) {
  return problem.derivatives == DerivativesBy::kAuto &&
         HasLanes(problem.recording->scene, problem.options) && !problem.recording->HasPlates() &&
         problem.sigmas.loss == FrameLoss::kHip;
}

LaneGroup::LaneGroup(std::vector<const RolloutProblem*> problems, const PersonLanes& lanes)
    : problems_(std::move(problems)),
      tables_(lanes, MostFrames(problems_), MostTails(problems_), MostFrames(problems_)) {
  for (size_t i = 0; i < problems_.size(); ++i) {
    const RolloutProblem& problem = *problems_[i];
    const int lane = static_cast<int>(i);
    tables_.Set(lane, problem.recording->scene, problem.options, problem.horizon);
  }
  const int frames = MostFrames(problems_);
  for (int t = 0; t < frames; ++t) {  // frame by frame, as they lie in memory
    for (size_t i = 0; i < problems_.size(); ++i) {
      const RolloutProblem& problem = *problems_[i];
      if (t >= problem.horizon) continue;
      const PendulumRecording& recording = *problem.recording;
      tables_.SetMeasured(static_cast<int>(i), t, recording.hip[0][t], recording.states[0][t],
                          problem.weight * recording.Weight(0, t));
    }
  }
}

std::vector<RolloutSums> LaneGroup::Evaluate(const std::vector<double const* const*>& blocks,
                                             LaneSums sums) const {
  const RolloutProblem& first = *problems_[0];
  const int columns = first.layout.num_acting();
  // A thread's own, used again.
  thread_local std::vector<double> constants, failed, residuals, squares, plain, robust;
  thread_local LaneParameters parameters;
  constants = tables_.constants();
  const int width = tables_.width();
  parameters.Clear(width);
  const bool derivatives = sums != LaneSums::kSquares && sums != LaneSums::kNone;
  for (size_t lane = 0; lane < problems_.size(); ++lane) {
    const RolloutProblem& problem = *problems_[lane];
    const ScenePerson& person = problem.recording->scene.people[0];
    const double* const free = problem.layout.VelocityBlock(blocks[lane]);
    for (int i = 0; i < 4; ++i) {
      constants[(kLaneStart + 4 + i) * width + lane] =
          free != nullptr ? free[i] : person.start.qd[i];
    }
    const auto sets = problem.layout.Parameters<double>(problem.map, blocks[lane]);
    const ParameterSet<double>& p = sets[0];
    parameters.Set(
        static_cast<int>(lane), p,
        derivatives ? problem.layout.Entries(problem.map, p, 0) : std::vector<ColumnEntry>());
  }
  LaneInputs in = tables_.Inputs();
  in.sigmas = first.sigmas;
  in.columns = columns;
  in.velocity_column = first.layout.VelocityColumn();
  parameters.In(&in);
  in.constants = constants.data();
  const int size = (columns + 1) * (columns + 1) * width;
  failed.resize(width);
  squares.resize(width);
  if (sums == LaneSums::kNone) residuals.resize((in.frames - 1) * kFrameResiduals * width);
  plain.resize(size);
  robust.resize(size);
  tables_.Roll(in, sums,
               {failed.data(), residuals.data(), squares.data(), plain.data(), robust.data()});
  std::vector<RolloutSums> results(problems_.size());
  for (size_t lane = 0; lane < results.size(); ++lane) {
    results[lane].ok = failed[lane] == 0.0;
    results[lane].squares = squares[lane];
    if (sums == LaneSums::kSquares || !results[lane].ok) continue;
    if (sums == LaneSums::kNone) {
      const int rows = problems_[lane]->num_motion_rows();
      results[lane].residuals.resize(rows);
      for (int k = 0; k < rows; ++k) results[lane].residuals[k] = residuals[k * width + lane];
      continue;
    }
    results[lane].plain = NormalEquations(columns, plain.data() + lane, width);
    if (sums != LaneSums::kRobust) continue;
    results[lane].robust = NormalEquations(columns, robust.data() + lane, width);
  }
  return results;
}

std::vector<SideBySide> PutSideBySide(const std::vector<RolloutAt>& rollouts) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    if (rollouts[i].problem != nullptr && HasLanes(*rollouts[i].problem)) order.push_back(i);
  }
  // Neighbours are of about the same length: a group takes as long as its longest.
  std::stable_sort(order.begin(), order.end(), [&rollouts](int i, int j) {
    return rollouts[i].problem->horizon > rollouts[j].problem->horizon;
  });
  std::vector<SideBySide> groups;
  for (size_t first = 0; first < order.size();) {
    const RolloutProblem& of_all = *rollouts[order[first]].problem;
    std::vector<int> members;
    std::vector<const RolloutProblem*> together;
    for (size_t i = first; i < order.size(); ++i) {
      const RolloutProblem* const next = rollouts[order[i]].problem.get();
      const bool full = static_cast<int>(members.size()) == BestPersonLanes().lanes;
      if (full || !SameLanes(of_all, *next)) break;
      members.push_back(order[i]);
      together.push_back(next);
    }
    first += members.size();
    groups.push_back({std::move(members), LaneGroup(std::move(together))});
  }
  return groups;
}

std::vector<RolloutSums> SumUp(const std::vector<SideBySide>& groups,
                               const std::vector<RolloutAt>& rollouts, LaneSums sums) {
  std::vector<RolloutSums> all(rollouts.size());
  for (const SideBySide& group : groups) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(rollouts[i].blocks.data());
    std::vector<RolloutSums> some = group.lanes.Evaluate(at, sums);
    for (size_t k = 0; k < some.size(); ++k) all[group.members[k]] = std::move(some[k]);
  }
  return all;
}

}  // namespace pushid
