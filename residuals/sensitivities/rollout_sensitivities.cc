// residuals: the chained forward sensitivities.
#include "residuals/sensitivities/rollout_sensitivities.h"

#include <algorithm>
#include <optional>

#include "models/reaction_delay.h"
#include "models/scene_forces.h"
#include "residuals/packed/packed_matrix.h"
#include "residuals/sensitivities/learned_pair_jacobian.h"
#include "residuals/sensitivities/network_sensitivities.h"

namespace pushid {
namespace {

// d [q, qd] of a delayed state / d columns. Before frame 0 people are at rest where they started.
void DelayedBlock(const RolloutSensitivities& sensitivities, int now, int person,
                  const DelayedPlace<double>& place, RolloutSensitivities::Block* block) {
  block->setZero();
  for (int i = 0; i < DelayedFrames<double>::kCount; ++i) {
    const int pose = now - place.of_pose.back - i, rate = now - place.of_rate.back - i;
    // A start's pose has no derivatives.
    if (pose >= 0) {
      block->topRows<4>() += place.of_pose.weight[i] * sensitivities.At(pose, person).topRows<4>();
    }
    if (rate >= 0) {
      block->bottomRows<4>() +=
          place.of_rate.weight[i] * sensitivities.At(rate, person).bottomRows<4>();
    }
  }
}

// Derivatives of what control perceives (models/reaction_delay.h), of one person at one frame. With
// S(t) = d [q, qd] / d columns and w_i the weights of a delayed state,
//   S_p = s S(t) + (1 - s) sum_i w_i S(t_i)  row by row, s the passive shares,
// and in the columns of the delays and of the shares, what these change.
class PerceivedSensitivities {
 public:
  explicit PerceivedSensitivities(int num_columns)
      : ankle_(8, num_columns), step_(RolloutSensitivities::Block::Zero(8, num_columns)) {}

  // entries: of the person's parameters.
  void Update(const ModelOptions& options, const ParameterSet<double>& p,
              const std::vector<ColumnEntry>& entries, const DelayedPlaces<double>& delayed,
              const RolloutPath<double>& path, const RolloutSensitivities& sensitivities, int frame,
              int person) {
    using State = Eigen::Matrix<double, 8, 1>;
    const auto add = [&entries](Parameter id, const State& by, RolloutSensitivities::Block* to) {
      for (const ColumnEntry& entry : entries) {
        if (entry.parameter == id) to->col(entry.column) += entry.derivative * by;
      }
    };
    const PendulumState<double>& now = path.At(frame, person);
    const DelayedState<double> then(path, frame, person, delayed.ankle);
    DelayedBlock(sensitivities, frame, person, delayed.ankle, &ankle_);
    const double stiffness = p[kPassiveStiffness], damping = p[kPassiveDamping];
    const auto of_now = sensitivities.At(frame, person);
    ankle_.middleRows<2>(2) =
        (1.0 - stiffness) * ankle_.middleRows<2>(2) + stiffness * of_now.middleRows<2>(2);
    ankle_.bottomRows<2>() = (1.0 - damping) * ankle_.bottomRows<2>() +
                             damping * (frame > 0 ? kRateAhead : 1.0) * of_now.bottomRows<2>();
    if (frame > 0) {
      ankle_.bottomRows<2>() +=
          damping * (1.0 - kRateAhead) * sensitivities.At(frame - 1, person).bottomRows<2>();
    }
    State by_delay, by_stiffness = State::Zero(), by_damping = State::Zero();
    by_delay << then.q_by_delay, then.qd_by_delay;
    by_delay.segment<2>(2) *= 1.0 - stiffness;
    by_delay.tail<2>() *= 1.0 - damping;
    by_stiffness.segment<2>(2) = now.q.tail<2>() - then.q.tail<2>();
    by_damping.tail<2>() = (PresentRate(path, frame, person) - then.qd).tail<2>();
    add(kReactionDelay, by_delay, &ankle_);
    add(kPassiveStiffness, by_stiffness, &ankle_);
    add(kPassiveDamping, by_damping, &ankle_);
    if (options.stance == Stance::kFixed) return;
    const DelayedState<double> then_step(path, frame, person, delayed.step);
    DelayedBlock(sensitivities, frame, person, delayed.step, &step_);
    by_delay << then_step.q_by_delay, then_step.qd_by_delay;
    add(StepDelayOf(options.delay), by_delay, &step_);
  }

  // Of [q, qd] as ankles and steps perceive it, by the columns. Feet that hold ask for no steps.
  const RolloutSensitivities::Block& ankle() const { return ankle_; }
  const RolloutSensitivities::Block& step() const { return step_; }

 private:
  RolloutSensitivities::Block ankle_, step_;
};

// A force's derivative by a parameter, onto the column that depends on it: most parameters act on
// one row or two.
template <typename Vector>
void AddWhereAny(const ColumnEntry& entry, const Vector& by_parameter, ForceColumns* by_column) {
  for (int row = 0; row < 4; ++row) {
    if (by_parameter[row] == 0.0) continue;
    (*by_column)(row, entry.column) += entry.derivative * by_parameter[row];
  }
}

// Of all that is learned: those given, or the options' own.
const double* LearnedWeights(const ModelOptions& options, const SensitivityInputs& inputs) {
  return inputs.network_weights != nullptr ? inputs.network_weights
                                           : options.learned->weights.data();
}

// Derivatives of what everybody gets from others.
class ReceivedSensitivities {
 public:
  ReceivedSensitivities(const Scene& scene, const ModelOptions& options,
                        const SensitivityInputs& inputs)
      : options_(options),
        inputs_(inputs),
        weights_(options.interaction.learned ? LearnedWeights(options, inputs) : nullptr),
        now_(scene.people.size(), ForceColumns::Zero(4, inputs.num_columns)) {
    for (const ColumnEntry& entry : inputs.entries[0]) {
      if (IsPairParameter(entry.parameter)) pair_entries_.push_back(entry);
    }
    if (weights_ == nullptr || inputs.weight_column >= 0) return;
    held_.emplace(options.learned->pair, weights_ + options.learned->pair_at());
  }

  // Of the interaction at one frame; forces: prepared for it.
  void Update(const RolloutSensitivities& sensitivities, int frame,
              const SceneForces<double>& forces) {
    if (!options_.interaction.Any()) return;
    for (ForceColumns& columns : now_) columns.setZero();
    if (held_) held_->Ask(forces);
    for (size_t k = 0; k < forces.acting().size(); ++k) {
      const auto& [n, j] = forces.acting()[k];
      const PairJacobian jacobian = Of(k, forces);
      for (int side = 0; side < 2; ++side) {
        ForceColumns& target = now_[side == 0 ? n : j];
        const auto by_states = jacobian.by_states.middleRows<4>(4 * side);
        AddNarrowProduct(by_states.leftCols<8>(), sensitivities.At(frame, n), target);
        AddNarrowProduct(by_states.rightCols<8>(), sensitivities.At(frame, j), target);
        for (const ColumnEntry& entry : pair_entries_) {
          AddWhereAny(
              entry,
              jacobian.by_parameter.block<4, 1>(4 * side, entry.parameter - kFirstPairParameter),
              &target);
        }
        if (weights_ == nullptr || held_) continue;
        target.middleCols(inputs_.weight_column + options_.learned->pair_at(), by_weight_.cols()) +=
            by_weight_.middleRows<4>(4 * side);
      }
    }
  }

  // Adds what person n feels of it.
  void AddTo(int n, ForceColumns* by_column) const {
    if (options_.interaction.Any()) *by_column += now_[n];
  }

 private:
  // Of the k-th two who act on each other; by_weight_ as well where weights are fitted.
  PairJacobian Of(size_t k, const SceneForces<double>& forces) {
    const auto& [n, j] = forces.acting()[k];
    const Pair pair = forces.pairs().Of(n, j);
    PairJacobian jacobian = ComputePairJacobian(options_.interaction, pair, forces.Parameters(0),
                                                forces.state(n), forces.state(j));
    if (held_) {
      held_->AddTo(k, forces, &jacobian);
    } else if (weights_ != nullptr) {
      const LearnedTerms& learned = *options_.learned;
      AddLearnedPairJacobian(learned.pair, weights_ + learned.pair_at(), pair, forces.Parameters(0),
                             forces.state(n), forces.state(j), &jacobian, &by_weight_);
    }
    return jacobian;
  }

  const ModelOptions& options_;
  const SensitivityInputs& inputs_;
  std::vector<ColumnEntry> pair_entries_;
  const double* weights_;  // of what is learned; null where no interaction is
  PairByWeight by_weight_;
  std::optional<HeldPairs> held_;  // where weights are, and are not fitted
  std::vector<ForceColumns> now_;
};

// Without what a person alone does not have.
std::vector<std::vector<ColumnEntry>> WithoutPairs(std::vector<std::vector<ColumnEntry>> entries) {
  for (std::vector<ColumnEntry>& of_one : entries) {
    of_one.erase(std::remove_if(of_one.begin(), of_one.end(),
                                [](const ColumnEntry& e) { return IsPairParameter(e.parameter); }),
                 of_one.end());
  }
  return entries;
}

// One for each person, or none.
std::vector<NetworkSensitivities> StartNetworks(const Scene& scene, const ModelOptions& options,
                                                const SensitivityInputs& inputs) {
  std::vector<NetworkSensitivities> networks;
  if (options.learned == nullptr || !options.learned->shape.any()) return networks;
  const LearnedTerms& network = *options.learned;
  const double* weights = LearnedWeights(options, inputs);
  for (const ScenePerson& person : scene.people) {
    networks.emplace_back(network.shape, weights, person.body.mass, inputs.num_columns,
                          inputs.weight_column);
  }
  return networks;
}

// What one person does in one step.
struct PersonStep {
  int frame, person;
  const SelfForce& self;
  const ParameterSet<double>& p;
  const PosedPendulum<double>& state;
  const Vector4<double>& previous;  // velocity, one frame before
  NetForce<double> force;
  Vector4<double> a;
  bool holds_fast;
  GroundStep ground;
};

// A rollout and its sensitivities, frame by frame.
class SensitivityRollout {
 public:
  SensitivityRollout(const Scene& scene, const ModelOptions& options,
                     const SensitivityInputs& inputs, int num_frames, RolloutPath<double>* path,
                     RolloutSensitivities* sensitivities)
      : scene_(scene),
        options_(options),
        inputs_(inputs),
        path_(*path),
        sensitivities_(*sensitivities),
        late_(options.delay != Delay::kNone),
        forces_(scene, options, inputs.parameters, inputs.network_weights),
        received_(scene, options, inputs),
        networks_(StartNetworks(scene, options, inputs)),
        own_entries_(WithoutPairs(inputs.entries)),
        perceived_(late_ ? inputs.num_columns : 0),
        by_column_(4, inputs.num_columns) {
    if (options.stance == Stance::kSteps) stance_.emplace(inputs.entries, inputs.num_columns);
    if (RodMoves(options)) {
      rod_.emplace(*options.learned, LearnedWeights(options, inputs), inputs.num_columns,
                   inputs.weight_column);
    }
    path_ = RolloutPath<double>(num_frames, scene.num_people());
    sensitivities_.Resize(num_frames, scene.num_people(), inputs.num_columns, rod_.has_value(),
                          stance_.has_value());
    for (int n = 0; n < scene.num_people(); ++n) Start(n);
  }

  RolloutStatus Run() {
    const int people = scene_.num_people(), last = path_.num_frames() - 1;
    for (int t = 0; t < last; ++t) {
      forces_.Update(path_, t);
      forces_.PrepareAll();
      received_.Update(sensitivities_, t, forces_);
      for (int n = 0; n < people; ++n) {
        const PersonStep step = StepOf(t, n);
        sensitivities_.AnglesAt(t, n) = step.force.angles;
        path_.At(t + 1, n) = forces_.Next(n, step.a, step.force, step.previous);
        const std::string_view outside = OutsideDomain(scene_.people[n].body, path_.At(t + 1, n));
        if (!outside.empty()) return {false, t + 1, n, outside};
        Advance(step);
      }
    }
    for (int n = 0; n < people; ++n) {
      sensitivities_.AnglesAt(last, n) = Angles<double>(path_.At(last, n).q);
    }
    return {};
  }

 private:
  void Start(int n) {
    path_.At(0, n) = {scene_.people[n].start.q, inputs_.initial_velocity[n]};
    path_.At(0, n).feet.apart = scene_.people[n].start.feet.apart;
    auto start = sensitivities_.At(0, n);
    start.setZero();
    sensitivities_.Rod(0, n).setZero();
    sensitivities_.Feet(0, n).setZero();
    if (inputs_.velocity_column >= 0) {
      start.block<4, 4>(4, inputs_.velocity_column + 4 * n).setIdentity();
    }
  }

  PersonStep StepOf(int t, int n) const {
    const Vector4<double>& previous = path_.At(std::max(t - 1, 0), n).qd;
    PersonStep step{t,
                    n,
                    forces_.self(n),
                    inputs_.parameters[n],
                    forces_.state(n),
                    previous,
                    forces_.On(n, t, previous),
                    {},
                    false,
                    {}};
    step.a = forces_.AccelerationOf(n, step.force);
    step.holds_fast = forces_.HoldsFast(step.force);
    step.ground = scene_.ground.StepAt(t);
    return step;
  }

  // Of the force, at fixed acceleration, by the person's own state and parameters.
  void ForceJacobian(const PersonStep& step) {
    const auto& [t, n, self, p, state, previous, force, a, holds_fast, ground] = step;
    const Perceived<double>* perceived = forces_.perceived(n);
    switch (options_.stance) {
      case Stance::kSteps:
        NetForceJacobianOfStance(scene_, options_, self, p, n, t, state, &jacobian_);
        break;
      case Stance::kFixed:
        NetForceJacobianOfStanding(scene_, options_, self, p, n, t, state, &jacobian_, perceived,
                                   &by_perceived_);
        break;
      case Stance::kSlide:
        NetForceJacobian(scene_, options_, self, p, n, t, state, previous, &jacobian_, perceived,
                         &by_perceived_);
        break;
    }
  }

  // Less what the equations of motion of `body` change by. Ground that moves is one more
  // acceleration, and another gravity (models/ground.h).
  void SubtractInverseDynamics(const PersonStep& step, const Body& body) {
    const Vector4<double> felt = step.a + step.ground.acceleration;
    const Angles<double>& angles = step.force.angles;
    const double gravity = step.ground.gravity;
    const Matrix4<double> rigid =
        InverseDynamicsJacobian(body, angles, step.state.qd, felt, gravity);
    jacobian_.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
    jacobian_.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
    if (rod_) {
      by_rod_ = -1.0 / body.rod_length *
                InverseDynamicsByBody(body, angles, step.state.qd, felt, gravity).col(1);
    }
    if (!step.holds_fast && options_.body != BodyModel::kTable) return;
    const Eigen::Matrix<double, 4, kNumBodyParameters> by =
        InverseDynamicsByBody(body, angles, step.state.qd, felt, gravity) *
        BodyJacobian(options_, step.self.body, step.p, step.holds_fast);
    for (int k = 0; k < kNumBodyParameters; ++k) {
      jacobian_.by_parameter.col(kBodyParameters[k]) -= by.col(k);
    }
  }

  // by_column_: of the force less that of the equations of motion, by the columns.
  void ForceByColumns(const PersonStep& step) {
    const int t = step.frame, n = step.person;
    const auto now = sensitivities_.At(t, n);
    if (jacobian_.by_state.leftCols<2>().isZero(0.0)) {  // only a user's law asks where one is
      SetNarrowProduct(jacobian_.by_state.rightCols<6>(), now.bottomRows<6>(), by_column_);
    } else {
      SetNarrowProduct(jacobian_.by_state, now, by_column_);
    }
    if (late_) {
      perceived_.Update(options_, step.p, own_entries_[n], forces_.delayed(n), path_,
                        sensitivities_, t, n);
    }
    if (stance_) {
      AdvanceFeet(step);
    } else if (late_) {
      AddNarrowProduct(by_perceived_.by_ankle, perceived_.ankle(), by_column_);
      AddNarrowProduct(by_perceived_.by_step, perceived_.step(), by_column_);
    }
    if (step.self.cart_derivative) {
      by_column_.topRows<2>() += jacobian_.by_previous.asDiagonal() *
                                 sensitivities_.At(std::max(t - 1, 0), n).middleRows<2>(4);
    }
    for (const ColumnEntry& entry : own_entries_[n]) {
      AddWhereAny(entry, jacobian_.by_parameter.col(entry.parameter), &by_column_);
    }
    if (rod_) by_column_.noalias() += by_rod_ * sensitivities_.Rod(t, n);
    if (!networks_.empty()) networks_[n].Advance(forces_.network(n), now);
    if (ForcesAt(scene_, options_.push, n, t) != ActiveForces::kAll) return;
    received_.AddTo(n, &by_column_);
    if (!networks_.empty()) networks_[n].AddTo(&by_column_);
  }

  void AdvanceFeet(const PersonStep& step) {
    const int t = step.frame, n = step.person;
    StanceSensitivities::Hip ankle(step.state, sensitivities_.At(t, n).data()), foot = ankle;
    if (late_) {
      ankle = {forces_.perceived(n)->ankle, perceived_.ankle().data()};
      foot = {forces_.perceived(n)->step, perceived_.step().data()};
    }
    stance_->Advance(step.self, step.p, n, ankle, foot, step.state.feet,
                     sensitivities_.Feet(t, n).data(),
                     ForcesAt(scene_, options_.push, n, t) == ActiveForces::kAll,
                     sensitivities_.Feet(t + 1, n).data(), &by_column_);
  }

  void AdvanceRod(const PersonStep& step) {
    const int t = step.frame, n = step.person;
    step.self.EffortJacobian(step.p, step.state, step.previous, &jacobian_);
    const RodStep rod{forces_.rod(n), step.self.body.mass, jacobian_,
                      networks_.empty() ? nullptr : &networks_[n], inputs_.entries[n]};
    const auto now = sensitivities_.Rod(t, n);
    sensitivities_.Rod(t + 1, n) =
        now + scene_.dt * rod_->Velocity(rod, sensitivities_.At(t, n),
                                         sensitivities_.At(std::max(t - 1, 0), n), now);
  }

  void Advance(const PersonStep& step) {
    const Body body = rod_ ? BodyNow(step.self.body, step.state.rod, 0.0)
                           : DynamicBody(options_, step.self.body, step.p, step.holds_fast);
    ForceJacobian(step);
    SubtractInverseDynamics(step, body);
    ForceByColumns(step);
    const auto now = sensitivities_.At(step.frame, step.person);
    auto next = sensitivities_.At(step.frame + 1, step.person);
    next.bottomRows<4>() = now.bottomRows<4>();
    const double dt = scene_.dt;
    const Matrix4<double> inverse =
        dt * InverseMassMatrix(body, step.force.angles, body.mass + dt * step.force.ground);
    AddNarrowProduct(inverse, by_column_, next.bottomRows<4>());
    next.topRows<4>() = now.topRows<4>() + dt * next.bottomRows<4>();
    if (rod_) AdvanceRod(step);
  }

  const Scene& scene_;
  const ModelOptions& options_;
  const SensitivityInputs& inputs_;
  RolloutPath<double>& path_;
  RolloutSensitivities& sensitivities_;
  const bool late_;
  SceneForces<double> forces_;
  ReceivedSensitivities received_;
  std::vector<NetworkSensitivities> networks_;
  std::optional<RodSensitivities> rod_;
  const std::vector<std::vector<ColumnEntry>> own_entries_;
  PerceivedSensitivities perceived_;
  std::optional<StanceSensitivities> stance_;
  SelfForce::Jacobian jacobian_;
  PerceivedJacobian by_perceived_;
  Vector4<double> by_rod_;
  ForceColumns by_column_;
};

}  // namespace

RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path,
                                       RolloutSensitivities* sensitivities) {
  return SensitivityRollout(scene, options, inputs, num_frames, path, sensitivities).Run();
}

}  // namespace pushid
