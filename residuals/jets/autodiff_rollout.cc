// residuals: passes over columns, and the choice of a width.
#include "residuals/jets/autodiff_rollout.h"

#include <algorithm>
#include <utility>

namespace pushid {
namespace {

constexpr int kPass = kGramBlock;  // columns of a pass, of which all columns are a multiple

}  // namespace

void StateColumns::Resize(int num_frames, int num_people, int num_columns) {
  num_people_ = num_people;
  num_columns_ = num_columns;
  const size_t size = Offset(num_frames, 0);
  if (storage_.size() < size) storage_.resize(size);
}

const std::vector<const RolloutJets*>& SupportedRolloutJets() {
  static const std::vector<const RolloutJets*> supported = [] {
#ifdef PUSHID_NATIVE
    return std::vector<const RolloutJets*>{&OfWidth<RolloutJets, 128>()};
#else
    std::vector<const RolloutJets*> all = Supported<RolloutJets>();
    while (all.back()->alignment != alignof(Vector4<double>)) all.pop_back();
    return all;
#endif
  }();
  return supported;
}

RolloutStatus RowsByJets(const RolloutProblem& problem, const SensitivityInputs& inputs,
                         std::vector<double>* residuals, RowMajorMatrix* rows,
                         const RolloutJets* jets) {
  if (jets == nullptr) jets = SupportedRolloutJets().back();
  residuals->resize(problem.num_residuals());
  rows->resize(problem.num_residuals(), inputs.num_columns);
  if (inputs.num_columns == 0) {
    return RolloutResidual::Rows<double>(problem, inputs.parameters, inputs.initial_velocity,
                                         inputs.network_weights, residuals->data());
  }
  RolloutStatus status;
  for (int first = 0; status.ok && first < inputs.num_columns; first += kPass) {
    status = jets->rows(problem, inputs, first, residuals->data(), rows->data());
  }
  return status;
}

RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path, StateColumns* columns) {
  *path = RolloutPath<double>(num_frames, scene.num_people());
  columns->Resize(num_frames, scene.num_people(), inputs.num_columns);
  RolloutStatus status;
  for (int first = 0; status.ok && first < inputs.num_columns; first += kPass) {
    status = SupportedRolloutJets().back()->states(scene, options, inputs, num_frames, first, path,
                                                   columns);
  }
  return status;
}

std::unique_ptr<StateStep> StepByJets(const Scene& scene, const ModelOptions& options,
                                      const std::vector<ParameterSet<double>>& parameters) {
  const RolloutJets& jets = *SupportedRolloutJets().back();
  return std::unique_ptr<StateStep>(jets.step(scene, options, parameters));
}

AutoDiffRollout::AutoDiffRollout(std::shared_ptr<const RolloutProblem> problem)
    : problem_(std::move(problem)), columns_(problem_->layout) {
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->num_residuals());
}

bool AutoDiffRollout::Evaluate(double const* const* blocks, double* residuals,
                               double** jacobians) const {
  if (jacobians == nullptr) return RolloutResidual{problem_}(blocks, residuals);
  const RolloutProblem& p = *problem_;
  std::vector<double> values;
  RowMajorMatrix rows;
  const SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  if (!RowsByJets(p, inputs, &values, &rows).ok) return false;
  std::copy(values.begin(), values.end(), residuals);
  columns_.Scatter(rows, 0, num_residuals(), jacobians);
  return true;
}

}  // namespace pushid
