// residuals: derivatives of rollouts by automatic differentiation: the models' own templates and
// RolloutResidual (rollout_residual.h) with a scalar that holds a value and its derivatives by
// eight columns (vector_jet.h), in as many passes as a recording has acting columns
// (parameter_map.h). Compiled once for each width of vectors, the widest that the processor has
// chosen at run time; the bits are those of every other width.
//
// Whatever a law is, this differentiates it. What is quicker, and for which models alone, says
// cost_functions/condensed_rollout.h.
#pragma once

#include <ceres/cost_function.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "models/pendulum_filter.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// d [q, qd] / d columns at every frame and person.
class StateColumns {
 public:
  using Block = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;
  void Resize(int num_frames, int num_people, int num_columns);
  Eigen::Map<Block> At(int frame, int person) {
    return {storage_.data() + Offset(frame, person), 8, num_columns_};
  }
  Eigen::Map<const Block> At(int frame, int person) const {
    return {storage_.data() + Offset(frame, person), 8, num_columns_};
  }

 private:
  size_t Offset(int frame, int person) const {
    return 8 * (static_cast<size_t>(frame) * num_people_ + person) * num_columns_;
  }
  int num_people_ = 0, num_columns_ = 0;
  std::vector<double> storage_;  // never shrinks
};

// What one width of vectors offers: eight columns of the inputs, from `first` on.
struct RolloutJets {
  int bits;               // of a vector
  std::size_t alignment;  // of the models' vectors, which must be that of everybody else
  RolloutStatus (*rows)(const RolloutProblem& problem, const SensitivityInputs& inputs, int first,
                        double* residuals, double* rows);
  RolloutStatus (*states)(const Scene& scene, const ModelOptions& options,
                          const SensitivityInputs& inputs, int num_frames, int first,
                          RolloutPath<double>* path, StateColumns* columns);
  StateStep* (*step)(const Scene& scene, const ModelOptions& options,
                     const std::vector<ParameterSet<double>>& parameters);  // the caller's
};

// What this processor can run, the widest last; never empty.
const std::vector<const RolloutJets*>& SupportedRolloutJets();

// All residuals of a recording, and their derivatives by the columns of the inputs:
// problem.num_residuals() x inputs.num_columns. jets: null for the widest.
RolloutStatus RowsByJets(const RolloutProblem& problem, const SensitivityInputs& inputs,
                         std::vector<double>* residuals, RowMajorMatrix* rows,
                         const RolloutJets* jets = nullptr);

// The path of a scene, and its derivatives.
RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path, StateColumns* columns);

// The step of a PendulumFilter. All arguments must outlive it.
std::unique_ptr<StateStep> StepByJets(const Scene& scene, const ModelOptions& options,
                                      const std::vector<ParameterSet<double>>& parameters);

// All rows of a recording as a Ceres cost function.
class AutoDiffRollout : public ceres::CostFunction {
 public:
  explicit AutoDiffRollout(std::shared_ptr<const RolloutProblem> problem);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::shared_ptr<const RolloutProblem> problem_;
  ActingColumns columns_;
};

// By the bits of a vector, as VectorKernelsOf; a build for one processor has the first alone.
template <int kBits>
const RolloutJets& RolloutJetsOf();
template <>
const RolloutJets& RolloutJetsOf<128>();
template <>
const RolloutJets& RolloutJetsOf<256>();
template <>
const RolloutJets& RolloutJetsOf<512>();

}  // namespace pushid
