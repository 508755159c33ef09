// residuals: the chained forward sensitivities.
#include "residuals/sensitivities/rollout_sensitivities.h"

#include <ceres/jet.h>

#include <algorithm>
#include <optional>

#include "residuals/packed/packed_matrix.h"
#include "residuals/sensitivities/body_sensitivities.h"
#include "residuals/sensitivities/delay_sensitivities.h"
#include "residuals/sensitivities/learned_pair_jacobian.h"
#include "residuals/sensitivities/network_sensitivities.h"
#include "residuals/sensitivities/stance_sensitivities.h"

namespace pushid {

Vector4<double> InverseDynamicsByRod(const Body& body, const PendulumState<double>& state,
                                     const Vector4<double>& a) {
  using Jet = ceres::Jet<double, 1>;
  const BodyOf<Jet> jets{Jet(body.mass), Jet(body.rod_length, 0), Jet(0.0), Jet(body.point_share),
                         Jet(body.pendulum_ratio)};
  const PendulumState<Jet> still{state.q.cast<Jet>(), state.qd.cast<Jet>()};
  const Vector4<Jet> value = InverseDynamics<Jet>(jets, still, a.cast<Jet>());
  return {value[0].v[0], value[1].v[0], value[2].v[0], value[3].v[0]};
}

namespace {

using Columns = NetworkSensitivities::ForceColumns;

// A force's derivative by a parameter, onto the column that depends on it: most parameters act on
// one row or two.
template <typename Vector>
void AddWhereAny(const ColumnEntry& entry, const Vector& by_parameter, Columns* by_column) {
  for (int row = 0; row < 4; ++row) {
    if (by_parameter[row] == 0.0) continue;
    (*by_column)(row, entry.column) += entry.derivative * by_parameter[row];
  }
}

const double* Weights(const ModelOptions& options, const SensitivityInputs& inputs) {
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
        weights_(options.interaction.learned ? Weights(options, inputs) : nullptr),
        now_(scene.people.size(), Columns::Zero(4, inputs.num_columns)) {
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
    for (Columns& columns : now_) columns.setZero();
    if (held_) held_->Ask(forces);
    for (size_t k = 0; k < forces.acting().size(); ++k) {
      const auto& [n, j] = forces.acting()[k];
      const PairJacobian jacobian = Of(k, forces);
      for (int side = 0; side < 2; ++side) {
        Columns& target = now_[side == 0 ? n : j];
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
  void AddTo(int n, Columns* by_column) const {
    if (options_.interaction.Any()) *by_column += now_[n];
  }

 private:
  // Of the k-th two who act on each other; by_weight_ as well where weights are fitted.
  PairJacobian Of(size_t k, const SceneForces<double>& forces) {
    const auto& [n, j] = forces.acting()[k];
    const Pair pair = forces.pairs().Of(n, j);
    PairJacobian jacobian =
        ComputePairJacobian(options_.interaction, options_.interaction_network.get(), pair,
                            forces.Parameters(0), forces.state(n), forces.state(j));
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
  std::vector<Columns> now_;
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
  const double* weights = Weights(options, inputs);
  for (const ScenePerson& person : scene.people) {
    networks.emplace_back(network.shape, weights, person.body.mass, inputs.num_columns,
                          inputs.weight_column);
  }
  return networks;
}

// d (step state) / d columns, one step on; by_state: d [q, qd] / d columns.
template <typename Rows>
void AdvanceStepState(const StanceJacobian& stance, const std::vector<ColumnEntry>& entries,
                      const Rows& by_state, Eigen::Ref<const Eigen::RowVectorXd> now,
                      Eigen::Ref<Eigen::RowVectorXd> next) {
  next.noalias() = stance.next_by_state * by_state;
  next += stance.next_by_step * now;
  for (const ColumnEntry& entry : entries) {
    next[entry.column] += entry.derivative * stance.next_by_parameter[entry.parameter];
  }
}

}  // namespace

RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path,
                                       RolloutSensitivities* sensitivities) {
  const int people = scene.num_people();
  SceneForces<double> forces(scene, options, inputs.parameters, inputs.network_weights);
  std::vector<NetworkSensitivities> networks = StartNetworks(scene, options, inputs);
  const bool rod_moves = RodMoves(options);
  std::optional<RodSensitivities> rod;
  if (rod_moves) {
    rod.emplace(*options.learned, Weights(options, inputs), inputs.num_columns,
                inputs.weight_column);
  }
  ReceivedSensitivities received(scene, options, inputs);
  *path = RolloutPath<double>(num_frames, people);
  const bool stands = options.stance == Stance::kThreshold;
  sensitivities->Resize(num_frames, people, inputs.num_columns, rod_moves, stands);
  for (int n = 0; n < people; ++n) {
    path->At(0, n) = {scene.people[n].start.q, inputs.initial_velocity[n]};
    auto start = sensitivities->At(0, n);
    start.setZero();
    sensitivities->Rod(0, n).setZero();
    sensitivities->StepState(0, n).setZero();
    if (inputs.velocity_column >= 0) {
      start.block<4, 4>(4, inputs.velocity_column + 4 * n).setIdentity();
    }
  }

  Columns by_column(4, inputs.num_columns);
  SelfForce::Jacobian jacobian;
  const std::vector<std::vector<ColumnEntry>> own_entries = WithoutPairs(inputs.entries);
  StanceJacobian stance;
  const bool late = options.delay != Delay::kNone;
  PerceivedJacobian by_perceived;
  std::optional<PerceivedSensitivities> perceived;
  if (late) perceived.emplace(inputs.num_columns);
  for (int t = 0; t + 1 < num_frames; ++t) {
    const int before = t > 0 ? t - 1 : 0;
    forces.Update(*path, t);
    forces.PrepareAll();
    received.Update(*sensitivities, t, forces);
    for (int n = 0; n < people; ++n) {
      const Body& body = scene.people[n].body;
      const SelfForce& self = forces.self(n);
      const ParameterSet<double>& p = inputs.parameters[n];
      const PendulumState<double>& state = path->At(t, n);
      const Vector4<double>& previous = path->At(before, n).qd;
      const NetForce<double> force = forces.On(n, t, previous);
      const Vector4<double> a = forces.AccelerationOf(n, force);
      sensitivities->AnglesAt(t, n) = force.angles;
      path->At(t + 1, n) = forces.Next(n, a, force, previous);
      const std::string_view outside = OutsideDomain(body, path->At(t + 1, n));
      if (!outside.empty()) return {false, t + 1, n, outside};

      // Ground that moves is one more acceleration, and another gravity (models/ground.h).
      GroundStep ground;
      if (scene.ground.moves()) ground = scene.ground.steps[t];
      const Vector4<double> felt = a + ground.acceleration;
      if (stands) {
        NetForceJacobianOfStance(scene, options, self, p, n, t, state, a, &jacobian, &stance,
                                 forces.perceived(n), &by_perceived);
      } else if (options.stance == Stance::kFixed) {
        NetForceJacobianOfStanding(scene, options, self, p, n, t, state, a, ground, &jacobian,
                                   forces.perceived(n), &by_perceived);
      } else {
        NetForceJacobian(scene, options, self, p, n, t, state, previous, &jacobian,
                         forces.perceived(n), &by_perceived);
      }
      const bool holds_fast = forces.HoldsFast(force);
      const Body now_body =
          rod_moves ? BodyNow(body, state.rod, 0.0) : DynamicBody(options, body, p, holds_fast);
      const Matrix4<double> rigid =
          InverseDynamicsJacobian(now_body, force.angles, state.qd, felt, ground.gravity);
      if (options.body == BodyModel::kTable) {
        SubtractInverseDynamicsByMasses(body, p, state, felt, ground.gravity, &jacobian);
      }
      jacobian.by_state.middleCols<2>(2) -= rigid.leftCols<2>();
      jacobian.by_state.middleCols<2>(6) -= rigid.rightCols<2>();
      const auto now = sensitivities->At(t, n);
      if (jacobian.by_state.leftCols<2>().isZero(0.0)) {  // only a user's law asks where one is
        SetNarrowProduct(jacobian.by_state.rightCols<6>(), now.bottomRows<6>(), by_column);
      } else {
        SetNarrowProduct(jacobian.by_state, now, by_column);
      }
      if (late) {
        perceived->Update(scene, options, p, *path, *sensitivities, t, n);
        perceived->AddTo(by_perceived.by_ankle, by_perceived.by_step, &by_column);
        perceived->AddParameters(by_perceived.by_ankle, by_perceived.by_step, &jacobian);
      }
      if (self.cart_derivative) {
        by_column.topRows<2>() +=
            jacobian.by_previous.asDiagonal() * sensitivities->At(before, n).middleRows<2>(4);
      }
      for (const ColumnEntry& entry : own_entries[n]) {
        AddWhereAny(entry, jacobian.by_parameter.col(entry.parameter), &by_column);
      }
      if (stands) {
        if (late) perceived->AddToStep(&stance);
        AdvanceStepState(stance, inputs.entries[n], now, sensitivities->StepState(t, n),
                         sensitivities->StepState(t + 1, n));
        if (late) perceived->AddToStepState(stance, sensitivities->StepState(t + 1, n));
        by_column.noalias() += stance.by_step * sensitivities->StepState(t, n);
      }
      const auto rod_now = sensitivities->Rod(t, n);
      if (rod_moves) by_column.noalias() -= InverseDynamicsByRod(now_body, state, felt) * rod_now;
      if (!networks.empty()) networks[n].Advance(forces.network(n), now);
      if (ForcesAt(scene, options.push, n, t) == ActiveForces::kAll) {
        received.AddTo(n, &by_column);
        if (!networks.empty()) networks[n].AddTo(&by_column);
      }
      auto next = sensitivities->At(t + 1, n);
      next.bottomRows<4>() = now.bottomRows<4>();
      const Matrix4<double> inverse =
          scene.dt *
          InverseMassMatrix(now_body, force.angles, now_body.mass + scene.dt * force.ground);
      AddNarrowProduct(inverse, by_column, next.bottomRows<4>());
      next.topRows<4>() = now.topRows<4>() + scene.dt * next.bottomRows<4>();
      if (!rod_moves) continue;
      self.TotalJacobian(p, state, previous, &jacobian);
      const RodStep step{forces.rod(n), body.mass, jacobian,
                         networks.empty() ? nullptr : &networks[n], inputs.entries[n]};
      sensitivities->Rod(t + 1, n) =
          rod_now + scene.dt * rod->Velocity(step, now, sensitivities->At(before, n), rod_now);
    }
  }
  for (int n = 0; n < people; ++n) {
    sensitivities->AnglesAt(num_frames - 1, n) = Angles<double>(path->At(num_frames - 1, n).q);
  }
  return {};
}

}  // namespace pushid
