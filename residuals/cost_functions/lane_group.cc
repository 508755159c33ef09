// residuals: numbers laid out in lanes, and what comes back.
#include "residuals/cost_functions/lane_group.h"

#include <algorithm>

#include "models/scene_forces.h"

namespace pushid {
namespace {

using TailPushes = std::vector<const ScenePush*>;

TailPushes PushesWithTails(const RolloutProblem& problem) {
  TailPushes pushes;
  if (problem.options.push_tail == PushTail::kNone) return pushes;
  for (const ScenePush& push : problem.recording->scene.pushes) {
    if (push.person == 0 && TailActs(push, push.EndFrame())) pushes.push_back(&push);
  }
  return pushes;
}

bool ActsOnOneAlone(const ColumnEntry& entry) { return entry.parameter < kLaneParameters; }

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

bool HasLanes(const RolloutProblem& problem) {
  const ModelOptions& options = problem.options;
  return problem.recording->num_people() == 1 && options.stance == Stance::kSlide &&
         options.learned == nullptr && options.own_laws.empty() && options.delay == Delay::kNone &&
         options.body != BodyModel::kTable && !problem.recording->scene.ground.moves() &&
         !problem.recording->HasPlates() && problem.sigmas.loss == FrameLoss::kHip;
}

LaneGroup::LaneGroup(std::vector<const RolloutProblem*> problems, const PersonLanes& lanes)
    : problems_(std::move(problems)), lanes_(&lanes), width_(lanes.lanes) {
  for (const RolloutProblem* problem : problems_) {
    frames_ = std::max(frames_, problem->horizon);
    num_tails_ = std::max(num_tails_, static_cast<int>(PushesWithTails(*problem).size()));
  }
  constants_.assign(kLaneConstants * width_, 1.0);  // of a lane that nobody is in
  steps_.assign(frames_ * kLaneFields * width_, 0.0);
  tails_.assign(num_tails_ * kLaneTails * width_, 0.0);
  for (size_t lane = 0; lane < problems_.size(); ++lane) {
    const RolloutProblem& problem = *problems_[lane];
    const Scene& scene = problem.recording->scene;
    const SelfForce self(problem.options, scene.people[0].body, scene.people[0].start.q, scene.dt);
    const int at = static_cast<int>(lane);
    Constant(kLaneMass, at) = self.body.mass;
    Constant(kLaneRod, at) = self.body.rod_length;
    Constant(kLaneHeight, at) = self.body.cart_height;
    Constant(kLanePointShare, at) = self.body.point_share;
    Constant(kLanePendulumRatio, at) = self.body.pendulum_ratio;
    Constant(kLaneScale, at) = self.scale.force;
    Constant(kLaneScale + 1, at) = self.scale.stiffness;
    Constant(kLaneScale + 2, at) = self.scale.damping;
    for (int i = 0; i < 2; ++i) {
      Constant(kLanePosture + i, at) = self.posture[i];
      Constant(kLaneHold + i, at) = self.hold[i];
    }
    Constant(kLaneStep, at) = scene.dt;
    for (int i = 0; i < 4; ++i) Constant(kLaneStart + i, at) = scene.people[0].start.q[i];
    SetSteps(at);
    SetTails(at);
  }
}

void LaneGroup::SetSteps(int lane) {
  const RolloutProblem& problem = *problems_[lane];
  const Scene& scene = problem.recording->scene;
  for (int t = 0; t < problem.horizon; ++t) {
    double* const step = steps_.data() + t * kLaneFields * width_ + lane;
    const auto set = [&](int field, double value) { step[field * width_] = value; };
    const MeasuredFrame measured = problem.Measured(t, 0);
    for (int i = 0; i < 3; ++i) set(kLaneHip + i, measured.hip[i]);
    const Vector4<double> push = PushForceAt(scene, 0, t);
    for (int i = 0; i < 4; ++i) {
      set(kLanePose + i, measured.state.q[i]);
      set(kLaneVelocity + i, measured.state.qd[i]);
      set(kLanePush + i, push[i]);
    }
    set(kLaneWeight, problem.weight * measured.weight);
    const ActiveForces active = ForcesAt(scene, problem.options.push, 0, t);
    set(kLaneActs, active == ActiveForces::kAll ? 1.0 : 0.0);
    set(kLaneSlides, active == ActiveForces::kPushOnly ? 0.0 : 1.0);
    friction_alone_ = friction_alone_ || active == ActiveForces::kPushAndFriction;
    set(kLaneGoesOn, t + 1 < problem.horizon ? 1.0 : 0.0);
  }
}

void LaneGroup::SetTails(int lane) {
  const RolloutProblem& problem = *problems_[lane];
  const TailPushes pushes = PushesWithTails(problem);
  for (size_t k = 0; k < pushes.size(); ++k) {
    double* const tail = tails_.data() + k * kLaneTails * width_ + lane;
    const TailOf<double> at_end = TailAt(*pushes[k], problem.recording->scene.people[0].body.mass,
                                         pushes[k]->EndFrame(), problem.recording->scene.dt);
    for (int i = 0; i < 4; ++i) tail[(kLaneMean + i) * width_] = at_end.mean[i];
    tail[kLaneMassPerForce * width_] = at_end.mass_per_force;
    tail[kLaneLogDuration * width_] = at_end.log_duration;
    tail[kLaneEnd * width_] = pushes[k]->EndFrame();
  }
}

std::vector<RolloutSums> LaneGroup::Evaluate(const std::vector<double const* const*>& blocks,
                                             LaneSums sums) const {
  const RolloutProblem& first = *problems_[0];
  const int columns = first.layout.num_acting();
  // A thread's own, used again.
  thread_local std::vector<double> constants, parameters, slopes, failed, squares, gradient, plain,
      robust, storage;
  thread_local std::vector<LaneEntry> entries;
  constants = constants_;
  parameters.assign(kLaneParameters * width_, 1.0);
  entries.clear();
  for (size_t lane = 0; lane < problems_.size(); ++lane) {
    const RolloutProblem& problem = *problems_[lane];
    const ScenePerson& person = problem.recording->scene.people[0];
    const double* const free = problem.layout.VelocityBlock(blocks[lane]);
    for (int i = 0; i < 4; ++i) {
      constants[(kLaneStart + 4 + i) * width_ + lane] =
          free != nullptr ? free[i] : person.start.qd[i];
    }
    const ParameterSet<double> p = problem.layout.Parameters<double>(problem.map, blocks[lane])[0];
    for (int i = 0; i < kLaneParameters; ++i) parameters[i * width_ + lane] = p[i];
    if (sums == LaneSums::kSquares) continue;
    int k = 0;
    for (const ColumnEntry& entry : problem.layout.Entries(problem.map, p, 0)) {
      if (!ActsOnOneAlone(entry)) continue;
      if (lane == 0) {
        entries.push_back({entry.column, entry.parameter});
        slopes.resize(entries.size() * width_, 0.0);
      }
      slopes[k++ * width_ + lane] = entry.derivative;
    }
  }
  LaneInputs in;
  in.friction = first.options.friction;
  in.cart_derivative = first.options.cart_derivative == CartDerivative::kBackward;
  in.friction_alone = friction_alone_;
  in.sigmas = first.sigmas;
  in.frames = frames_;
  in.columns = columns;
  in.velocity_column = first.layout.VelocityColumn();
  in.num_entries = static_cast<int>(entries.size());
  in.num_tails = num_tails_;
  in.entries = entries.data();
  in.slopes = slopes.data();
  in.constants = constants.data();
  in.parameters = parameters.data();
  in.tails = tails_.data();
  in.steps = steps_.data();
  const int size = (columns + 1) * (columns + 1) * width_;
  failed.resize(width_);
  squares.resize(width_);
  gradient.resize(columns * width_);
  plain.resize(size);
  robust.resize(size);
  storage.resize(LaneStorage(width_, columns, frames_));
  lanes_->roll(in, sums,
               {failed.data(), squares.data(), gradient.data(), plain.data(), robust.data(),
                storage.data()});
  std::vector<RolloutSums> results(problems_.size());
  for (size_t lane = 0; lane < results.size(); ++lane) {
    results[lane].ok = failed[lane] == 0.0;
    results[lane].squares = squares[lane];
    if (sums == LaneSums::kSquares || !results[lane].ok) continue;
    if (sums == LaneSums::kGradient) {
      using EveryLane = Eigen::InnerStride<Eigen::Dynamic>;
      results[lane].gradient = Eigen::Map<const Eigen::VectorXd, 0, EveryLane>(
          gradient.data() + lane, columns, EveryLane(width_));
      continue;
    }
    results[lane].plain = NormalEquations(columns, plain.data() + lane, width_);
    if (sums != LaneSums::kRobust) continue;
    results[lane].robust = NormalEquations(columns, robust.data() + lane, width_);
  }
  return results;
}

std::vector<SideBySide> PutSideBySide(const std::vector<const RolloutProblem*>& problems) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(problems.size()); ++i) {
    if (problems[i] != nullptr) order.push_back(i);
  }
  // Neighbours are of about the same length: a group takes as long as its longest.
  std::stable_sort(order.begin(), order.end(), [&problems](int i, int j) {
    return problems[i]->horizon > problems[j]->horizon;
  });
  std::vector<SideBySide> groups;
  for (size_t first = 0; first < order.size();) {
    const RolloutProblem& of_all = *problems[order[first]];
    std::vector<int> members;
    std::vector<const RolloutProblem*> together;
    for (size_t i = first; i < order.size(); ++i) {
      const bool full = static_cast<int>(members.size()) == BestPersonLanes().lanes;
      if (full || !SameLanes(of_all, *problems[order[i]])) break;
      members.push_back(order[i]);
      together.push_back(problems[order[i]]);
    }
    first += members.size();
    groups.push_back({std::move(members), LaneGroup(std::move(together))});
  }
  return groups;
}

}  // namespace pushid
