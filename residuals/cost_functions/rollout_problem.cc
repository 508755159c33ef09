// residuals: rollouts and their residuals by forward sensitivities.
#include "residuals/cost_functions/rollout_problem.h"

#include <algorithm>

#include "residuals/packed/packed_matrix.h"

namespace pushid {

std::vector<std::string> PoolingUnits(const PendulumRecording& recording,
                                      const std::string& pool_by) {
  if (!HoldsForRecording(pool_by)) return recording.subject_ids;
  const std::string& label = recording.labels.Of(pool_by);
  const std::string& unit = label.empty() ? recording.labels.setting() : label;
  return std::vector<std::string>(recording.scene.people.size(), unit);
}

std::optional<double> NumberOf(const PendulumRecording& recording, int person,
                               const std::string& key) {
  if (person < static_cast<int>(recording.known.size())) {
    const auto& numbers = recording.known[person].numbers;
    const auto found = numbers.find(key);
    if (found != numbers.end()) return found->second;
  }
  const Body& body = recording.scene.people[person].body;
  if (key == kMassCovariate) return body.mass;
  if (key == kRodCovariate) return body.rod_length;
  return std::nullopt;
}

std::string LabelOf(const PendulumRecording& recording, int person, const std::string& key) {
  if (const std::string& label = recording.labels.Of(key); !label.empty()) return label;
  if (person >= static_cast<int>(recording.known.size())) return "";
  const auto& texts = recording.known[person].texts;
  const auto found = texts.find(key);
  return found != texts.end() ? found->second : "";
}

std::vector<std::vector<double>> CovariatesOf(const PendulumRecording& recording,
                                              const std::vector<Covariate>& covariates) {
  std::vector<std::vector<double>> of_each;
  if (covariates.empty()) return of_each;
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    std::vector<double>& own = of_each.emplace_back();
    for (const Covariate& c : covariates) {
      double x = 0.0;
      if (c.is_contrast()) {
        const std::string label = LabelOf(recording, n, c.key);
        x = label == c.second ? 0.5 : label == c.first ? -0.5 : 0.0;
      } else if (const std::optional<double> number = NumberOf(recording, n, c.key)) {
        x = *number - c.centre;
      }
      own.push_back(x);
    }
  }
  return of_each;
}

BlockLayout LayoutOf(const PendulumRecording& recording, const ParameterMap& map,
                     bool free_velocity) {
  return BlockLayout(map, PoolingUnits(recording, map.pool_by), free_velocity,
                     CovariatesOf(recording, map.covariates));
}

std::shared_ptr<const RolloutProblem> MakeRolloutProblem(const PendulumRecording& recording,
                                                         const ModelOptions& options,
                                                         const ParameterMap& map,
                                                         const ResidualSigmas& sigmas,
                                                         double weight, int horizon) {
  auto problem = std::make_shared<RolloutProblem>();
  problem->recording = &recording;
  problem->options = options;
  problem->map = map;
  problem->layout = LayoutOf(recording, map, recording.initial_velocity == InitialVelocity::kFree);
  problem->sigmas = sigmas;
  problem->weight = weight;
  const int frames = recording.num_frames();
  problem->horizon = horizon > 0 ? std::min(horizon, frames) : frames;
  return problem;
}

SensitivityInputs RolloutInputs(const Scene& scene, const ParameterMap& map,
                                const BlockLayout& layout, double const* const* blocks) {
  SensitivityInputs inputs;
  inputs.parameters = layout.Parameters<double>(map, blocks);
  inputs.initial_velocity = InitialVelocities(scene);
  if (const double* free = layout.VelocityBlock(blocks)) {
    for (int n = 0; n < scene.num_people(); ++n) {
      inputs.initial_velocity[n] = Eigen::Map<const Vector4<double>>(free + 4 * n);
    }
  }
  for (int n = 0; n < scene.num_people(); ++n) {
    inputs.entries.push_back(layout.Entries(map, inputs.parameters[n], n));
  }
  inputs.num_columns = NormalEquations::PaddedSize(layout.num_acting());
  inputs.velocity_column = layout.VelocityColumn();
  inputs.network_weights = layout.WeightBlock(blocks);
  inputs.weight_column = layout.WeightColumn();
  return inputs;
}

void ScatterJacobian(const Eigen::Ref<const RowMajorMatrix>& jacobian,
                     const std::vector<int>& block_sizes, int first_row, int total_rows,
                     double** jacobians) {
  int column = 0;
  for (size_t b = 0; b < block_sizes.size(); column += block_sizes[b++]) {
    if (jacobians[b] == nullptr) continue;
    Eigen::Map<RowMajorMatrix> block(jacobians[b], total_rows, block_sizes[b]);
    block.middleRows(first_row, jacobian.rows()) = jacobian.middleCols(column, block_sizes[b]);
  }
}

RowMajorMatrix ActingColumns::Expand(const Eigen::Ref<const RowMajorMatrix>& by_acting) const {
  RowMajorMatrix all(by_acting.rows(), of_column_.size());
  for (Eigen::Index column = 0; column < all.cols(); ++column) {
    const auto [first, last] = of_column_[static_cast<size_t>(column)];
    all.col(column) = by_acting.col(first);
    for (int k = first + 1; k <= last; ++k) all.col(column) += by_acting.col(k);
  }
  return all;
}

void ActingColumns::Scatter(const Eigen::Ref<const RowMajorMatrix>& by_acting, int first_row,
                            int total_rows, double** jacobians) const {
  const auto* column = of_column_.data();
  for (size_t b = 0; b < block_sizes_.size(); column += block_sizes_[b++]) {
    if (jacobians[b] == nullptr) continue;
    const Eigen::Index size = block_sizes_[b];
    Eigen::Map<RowMajorMatrix> block(jacobians[b], total_rows, size);
    for (Eigen::Index row = 0; row < by_acting.rows(); ++row) {
      const double* const from = by_acting.row(row).data();
      double* const to = block.row(first_row + row).data();
      for (Eigen::Index i = 0; i < size; ++i) {
        to[i] = from[column[i].first];
        for (int k = column[i].first + 1; k <= column[i].second; ++k) to[i] += from[k];
      }
    }
  }
}

Derivatives WantedDerivatives(const RolloutProblem& problem, double** jacobians) {
  if (jacobians == nullptr) return Derivatives::kNone;
  const bool weights = jacobians[problem.layout.num_blocks() - 1] != nullptr;
  return problem.map.num_weights == 0 || weights ? Derivatives::kAll : Derivatives::kHeldWeights;
}

RolloutStatus RollOut(const RolloutProblem& p, double const* const* blocks, Derivatives derivatives,
                      SensitivityInputs* inputs, RolloutPath<double>* path,
                      RolloutSensitivities* sensitivities) {
  const Scene& scene = p.recording->scene;
  *inputs = RolloutInputs(scene, p.map, p.layout, blocks);
  if (derivatives == Derivatives::kHeldWeights && inputs->weight_column >= 0) {
    inputs->num_columns = NormalEquations::PaddedSize(inputs->weight_column);
    inputs->weight_column = -1;
  }
  if (derivatives == Derivatives::kNone) {
    return Rollout<double>(scene, p.options, inputs->parameters, inputs->initial_velocity,
                           p.horizon, path, nullptr, inputs->network_weights);
  }
  return RolloutWithSensitivities(scene, p.options, *inputs, p.horizon, path, sensitivities);
}

namespace {

// Rows of platforms without derivatives, of a rollout that is there.
void VisitPlateValues(const RolloutProblem& p, const SensitivityInputs& inputs,
                      const RolloutPath<double>& path, const PlateVisitor& visit) {
  const std::vector<int> people = p.PeopleOnPlates();
  const auto bodies = BodiesOnPlates<BodyOnPlates<double>>(p, inputs.parameters);
  PlateRows none(kPlateResiduals, 0);
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (size_t k = 0; k < people.size(); ++k) {
      const int n = people[k];
      const PlatePlace place{&p.recording->scene, &p.options, n, t};
      visit(t, n,
            p.weight * PlateResidual<double>(place, bodies[k], inputs.parameters[n], path.At(t, n),
                                             path.At(t + 1, n).qd, p.recording->plates[n][t],
                                             p.sigmas),
            &none);
    }
  }
}

// The same with derivatives.
void VisitPlateRows(const RolloutProblem& p, const SensitivityInputs& inputs,
                    const RolloutPath<double>& path, const RolloutSensitivities& sensitivities,
                    const PlateVisitor& visit) {
  const std::vector<int> people = p.PeopleOnPlates();
  const auto bodies = BodiesOnPlates<BodyOnPlatesJacobian>(p, inputs.parameters);
  PlateRows by_column(kPlateResiduals, inputs.num_columns);
  PlateJacobian jacobian;
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (size_t k = 0; k < people.size(); ++k) {
      const int n = people[k];
      const PlatePlace place{&p.recording->scene, &p.options, n, t};
      const PlateVector<double> r =
          p.weight * PlateResidualWithJacobian(place, bodies[k], inputs.parameters[n],
                                               path.At(t, n), path.At(t + 1, n).qd,
                                               p.recording->plates[n][t], p.sigmas, &jacobian);
      jacobian *= p.weight;
      SetNarrowProduct(jacobian.leftCols<8>(), sensitivities.At(t, n), by_column);
      AddNarrowProduct(jacobian.middleCols<4>(8), sensitivities.At(t + 1, n).bottomRows<4>(),
                       by_column);
      for (const ColumnEntry& entry : inputs.entries[n]) {
        for (int i = 0; i < kNumPlateParameters; ++i) {
          if (entry.parameter != PlateParameter(i)) continue;
          by_column.col(entry.column) += entry.derivative * jacobian.col(12 + i);
        }
      }
      visit(t, n, r, &by_column);
    }
  }
}

}  // namespace

RolloutStatus VisitFrames(const RolloutProblem& p, double const* const* blocks,
                          Derivatives derivatives, const FrameVisitor& visit,
                          const PlateVisitor& plates) {
  const Scene& scene = p.recording->scene;
  const bool with_rows = derivatives != Derivatives::kNone;
  SensitivityInputs inputs;
  // A thread's own, used again: asking the system for it each time costs a tenth of a rollout.
  thread_local RolloutPath<double> path;
  thread_local RolloutSensitivities sensitivities;
  const RolloutStatus status = RollOut(p, blocks, derivatives, &inputs, &path, &sensitivities);
  if (!status.ok) return status;

  const bool rod_moves = RodMoves(p.options);
  FrameJacobian<8> by_state;
  FrameJacobian<10> by_rod;  // by_state, by the rod, by the cart's lift
  FrameRows by_column(kFrameResiduals, with_rows ? inputs.num_columns : 0);
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < scene.num_people(); ++n) {
      const Body& body = scene.people[n].body;
      const PendulumState<double>& state = path.At(t, n);
      const double lift = inputs.parameters[n][kRodLift];
      FrameVector<double> r;
      if (!with_rows) {
        r = p.weight * FrameResidual<double>(BodyNow(body, state.rod, lift), state,
                                             p.Measured(t, n), p.sigmas);
        visit(t, n, r, &by_column);
        continue;
      }
      const PosedPendulum<double> posed(state, sensitivities.AnglesAt(t, n));
      if (rod_moves) {
        r = p.weight *
            MovingRodResidualWithJacobian(body, lift, posed, p.Measured(t, n), p.sigmas, &by_rod);
        by_state = by_rod.leftCols<8>();
      } else {
        r = p.weight *
            FrameResidualWithJacobian(body, posed, p.Measured(t, n), p.sigmas, &by_state);
      }
      by_state *= p.weight;
      SetNarrowProduct(by_state, sensitivities.At(t, n), by_column);
      if (rod_moves) {
        by_column.noalias() += (p.weight * by_rod.col(8)) * sensitivities.Rod(t, n);
        for (const ColumnEntry& entry : inputs.entries[n]) {
          if (entry.parameter != kRodLift) continue;
          by_column.col(entry.column) += (p.weight * entry.derivative) * by_rod.col(9);
        }
      }
      visit(t, n, r, &by_column);
    }
  }
  if (plates && with_rows) VisitPlateRows(p, inputs, path, sensitivities, plates);
  if (plates && !with_rows) VisitPlateValues(p, inputs, path, plates);
  return status;
}

bool RolloutResiduals(const RolloutProblem& problem, double const* const* blocks,
                      double* residuals) {
  return VisitFrames(
             problem, blocks, Derivatives::kNone,
             [&residuals](int, int, const FrameVector<double>& r, FrameRows*) {
               Eigen::Map<FrameVector<double>>{residuals} = r;
               residuals += kFrameResiduals;
             },
             [&residuals](int, int, const PlateVector<double>& r, PlateRows*) {
               Eigen::Map<PlateVector<double>>{residuals} = r;
               residuals += kPlateResiduals;
             })
      .ok;
}

}  // namespace pushid
