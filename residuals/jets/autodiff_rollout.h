// residuals: derivatives of rollouts by automatic differentiation: the models' own templates and
// RolloutResidual (rollout_residual.h) with a scalar that holds a value and its derivatives by
// eight columns (models/jet.h), in as many passes as a recording has acting columns
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
#include "residuals/kernels/vector_kernels.h"
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

namespace {

// Inputs of a rollout, with their derivatives by the eight columns from `first` on.
struct JetInputs {
  using Jet = VectorJet;
  std::vector<ParameterSet<Jet>> parameters;
  std::vector<Vector4<Jet>> velocity;
  std::vector<Jet> weights;

  JetInputs(const ModelOptions& options, const SensitivityInputs& in, int first) {
    const auto seed = [first](Jet* jet, int column, double slope) {
      if (column < first || column >= first + Jet::kColumns) return;
      jet->AddSlope(column - first, slope);
    };
    const size_t people = in.parameters.size();
    parameters.resize(people);
    velocity.resize(people);
    for (size_t n = 0; n < people; ++n) {
      for (int i = 0; i < kNumParameters; ++i) parameters[n][i] = Jet(in.parameters[n][i]);
      for (const ColumnEntry& entry : in.entries[n]) {
        seed(&parameters[n][entry.parameter], entry.column, entry.derivative);
      }
      for (int i = 0; i < 4; ++i) {
        velocity[n][i] = Jet(in.initial_velocity[n][i]);
        if (in.velocity_column < 0) continue;
        seed(&velocity[n][i], in.velocity_column + 4 * static_cast<int>(n) + i, 1.0);
      }
    }
    if (options.learned == nullptr) return;
    const double* const from =
        in.network_weights != nullptr ? in.network_weights : options.learned->weights.data();
    weights.resize(options.learned->weights.size());
    for (size_t i = 0; i < weights.size(); ++i) {
      weights[i] = Jet(from[i]);
      if (in.weight_column < 0) continue;
      seed(&weights[i], in.weight_column + static_cast<int>(i), 1.0);
    }
  }
  const Jet* network() const { return weights.empty() ? nullptr : weights.data(); }
};

}  // namespace

// Passes of one width of vectors: eight columns of the inputs, from `first` on.
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

PUSHID_WIDTHS(RolloutJets);

// The jets that this processor can run, the widest last: of a build for one processor one alone,
// else those that align the models' vectors as everybody else does.
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

}  // namespace pushid
