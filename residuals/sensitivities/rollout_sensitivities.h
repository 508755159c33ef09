// residuals: a rollout together with its derivatives, carried forward step by step.
//
// With s = [q, qd] of a person and S = ds/d(columns), M a = F - C - G gives
//   da = M^-1 (dF/ds - d(M a + C + G)/ds at fixed a) S + M^-1 dF/dp dp/d(columns)
//   S_qd <- S_qd + dt da,   S_q <- S_q + dt S_qd
// Only d(M a + C + G), over the four states it depends on, and the interaction of two people who
// touch need automatic differentiation; a whole Jet rollout costs as many sweeps as there are
// columns (measured in tests/benchmarks). States beside s are carried in the same way: a network's
// memory and a rod that moves (network_sensitivities.h), and the feet of who
// stands and steps (stance_sensitivities.h).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/rollout.h"
#include "residuals/parameter_map.h"
#include "residuals/sensitivities/net_force_jacobian.h"
#include "residuals/sensitivities/stance_sensitivities.h"

namespace pushid {

// What a rollout is run with: one entry per person.
struct SensitivityInputs {
  std::vector<ParameterSet<double>> parameters;
  std::vector<Vector4<double>> initial_velocity;
  std::vector<std::vector<ColumnEntry>> entries;
  int num_columns = 0;                      // a multiple of kGramBlock where feet step
  int velocity_column = -1;                 // first of 4 * people columns; negative when not fitted
  const double* network_weights = nullptr;  // all of options.learned, instead of its own
  int weight_column = -1;                   // of the first of them; negative when not fitted
};

// d [q, qd] / d columns at every frame and person; beside it of the rod, where it moves, and of the
// feet, where they stand and step.
class RolloutSensitivities {
 public:
  using Block = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;
  using FeetBlock = Eigen::Matrix<double, kFeetStates, Eigen::Dynamic, Eigen::RowMajor>;
  using Row = Eigen::Map<Eigen::RowVectorXd>;
  using ConstRow = Eigen::Map<const Eigen::RowVectorXd>;
  void Resize(int num_frames, int num_people, int num_columns, bool rod_moves = false,
              bool feet_step = false) {
    num_people_ = num_people;
    num_columns_ = num_columns;
    const Eigen::Index all = static_cast<Eigen::Index>(num_frames) * num_people * num_columns;
    if (storage_.size() < 8 * all) storage_.resize(8 * all);
    angles_.resize(static_cast<size_t>(num_frames) * num_people);
    rod_.resize(rod_moves ? all : 0);
    feet_.resize(feet_step ? kFeetStates * all : 0);
  }
  Eigen::Map<Block> At(int frame, int person) {
    return {storage_.data() + 8 * Offset(frame, person), 8, num_columns_};
  }
  Eigen::Map<const Block> At(int frame, int person) const {
    return {storage_.data() + 8 * Offset(frame, person), 8, num_columns_};
  }
  // Of each state on the way, which those who go on with it need not take again.
  Angles<double>& AnglesAt(int frame, int person) {
    return angles_[static_cast<size_t>(frame) * num_people_ + person];
  }
  // d l / d columns; empty where the rod is constant.
  Row Rod(int frame, int person) {
    return {rod_.data() + RowOffset(rod_, frame, person), RowSize(rod_)};
  }
  ConstRow Rod(int frame, int person) const {
    return {rod_.data() + RowOffset(rod_, frame, person), RowSize(rod_)};
  }
  // d [apart, clock, swing_time] / d columns; empty where feet slide.
  Eigen::Map<FeetBlock> Feet(int frame, int person) {
    return {feet_.data() + kFeetStates * RowOffset(feet_, frame, person), kFeetStates,
            RowSize(feet_)};
  }

 private:
  Eigen::Index RowOffset(const Eigen::RowVectorXd& rows, int frame, int person) const {
    return rows.size() > 0 ? Offset(frame, person) : 0;
  }
  int RowSize(const Eigen::RowVectorXd& rows) const { return rows.size() > 0 ? num_columns_ : 0; }
  Eigen::Index Offset(int frame, int person) const {
    return (static_cast<Eigen::Index>(frame) * num_people_ + person) * num_columns_;
  }
  int num_people_ = 0, num_columns_ = 0;
  Eigen::VectorXd storage_;  // the blocks, one after the other; never shrinks
  Eigen::RowVectorXd rod_, feet_;
  std::vector<Angles<double>> angles_;
};

// Same path as Rollout<double>, to the last bit.
RolloutStatus RolloutWithSensitivities(const Scene& scene, const ModelOptions& options,
                                       const SensitivityInputs& inputs, int num_frames,
                                       RolloutPath<double>* path,
                                       RolloutSensitivities* sensitivities);

}  // namespace pushid
