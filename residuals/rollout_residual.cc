// residuals: what a rollout's residual is made of.
#include "residuals/rollout_residual.h"

#include <algorithm>

namespace pushid {

std::vector<int> RolloutProblem::PeopleOnPlates() const {
  std::vector<int> people;
  for (int n = 0; n < recording->num_people(); ++n) {
    if (recording->HasPlates(n)) people.push_back(n);
  }
  return people;
}

int RolloutProblem::num_plate_rows() const {
  return (horizon - 1) * static_cast<int>(PeopleOnPlates().size()) * kPlateResiduals;
}

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

std::shared_ptr<const RolloutProblem> MakeRolloutProblem(
    const PendulumRecording& recording, const ModelOptions& options, const ParameterMap& map,
    const ResidualSigmas& sigmas, double weight, int horizon, DerivativesBy derivatives) {
  auto problem = std::make_shared<RolloutProblem>();
  problem->recording = &recording;
  problem->options = options;
  problem->map = map;
  problem->layout = LayoutOf(recording, map, recording.initial_velocity == InitialVelocity::kFree);
  problem->sigmas = sigmas;
  problem->weight = weight;
  const int frames = recording.num_frames();
  problem->derivatives = derivatives;
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

RolloutStatus RollOut(const RolloutProblem& p, double const* const* blocks,
                      RolloutPath<double>* path) {
  const Scene& scene = p.recording->scene;
  const SensitivityInputs inputs = RolloutInputs(scene, p.map, p.layout, blocks);
  return Rollout<double>(scene, p.options, inputs.parameters, inputs.initial_velocity, p.horizon,
                         path, nullptr, inputs.network_weights);
}

bool RolloutResiduals(const RolloutProblem& p, double const* const* blocks, double* residuals) {
  return RolloutResidual::At<double>(p, blocks, residuals).ok;
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

}  // namespace pushid
