// residuals: scenes in lanes, or one after the other.
#include "residuals/cost_functions/scene_rollouts.h"

#include <algorithm>
#include <utility>

namespace pushid {

SceneRollouts::SceneRollouts(std::vector<Scene> scenes, const ModelOptions& options, int begin,
                             int end)
    : scenes_(std::move(scenes)),
      options_(options),
      begin_(begin),
      end_(end),
      inside_(scenes_.size(), true) {
  const int total = static_cast<int>(scenes_.size());
  if (!HasLanes(scenes_[0], options_)) return;
  for (int first = 0; first < total;) {
    const PersonLanes& lanes = PersonLanesFor(total - first);
    const int count = std::min(lanes.lanes, total - first);
    int tails = 0, steps = 1;
    for (int i = first; i < first + count; ++i) {
      tails = std::max(tails, NumTails(scenes_[i], options_));
      steps = std::max(steps, NumSteps(scenes_[i], end_));
    }
    Group group{LaneTables(lanes, end_, tails, steps), first, count, {}, {}};
    for (int i = 0; i < count; ++i) group.tables.Set(i, scenes_[first + i], options_, end_);
    groups_.push_back(std::move(group));
    first += count;
  }
}

bool SceneRollouts::Roll(const std::vector<ParameterSet<double>>& parameters,
                         const double* network_weights) {
  for (Group& group : groups_) RollGroup(parameters[0], {}, 0, end_, group, &group.states);
  const size_t one_by_one = groups_.empty() ? scenes_.size() : 0;
  paths_.resize(one_by_one);
  last_.resize(one_by_one);
  for (size_t i = 0; i < one_by_one; ++i) {
    const RolloutStatus status =
        Rollout<double>(scenes_[i], options_, parameters, InitialVelocities(scenes_[i]), end_,
                        &paths_[i], nullptr, network_weights);
    inside_[i] = status.ok;
    last_[i] = (status.ok ? end_ : status.frame) - 1;
  }
  return std::find(inside_.begin(), inside_.end(), false) == inside_.end();
}

bool SceneRollouts::Differentiate(const SensitivityInputs& inputs, int columns,
                                  const std::vector<int>& frames) {
  columns_ = columns;
  for (Group& group : groups_) {
    const auto asked = frames.begin() + group.first;
    const int most = *std::max_element(asked, asked + group.count);
    if (most == 0) continue;
    if (!RollGroup(inputs.parameters[0], inputs.entries[0], columns, most, group,
                   &group.derivatives)) {
      return false;
    }
  }
  sensitivities_.resize(paths_.size());
  SensitivityInputs of_scene = inputs;
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (frames[i] == 0) continue;
    of_scene.initial_velocity = InitialVelocities(scenes_[i]);
    if (!RolloutWithSensitivities(scenes_[i], options_, of_scene, frames[i], &paths_[i],
                                  &sensitivities_[i])
             .ok) {
      return false;
    }
  }
  return true;
}

bool SceneRollouts::RollGroup(const ParameterSet<double>& parameters,
                              const std::vector<ColumnEntry>& entries, int columns, int end,
                              const Group& group, std::vector<double>* states) {
  // A thread's own, used again.
  thread_local LaneParameters of_lanes;
  thread_local std::vector<double> failed, squares;
  const int width = group.tables.width();
  LaneInputs in = group.tables.Inputs();
  in.frames = end;
  in.first_state = begin_;
  in.columns = columns;
  of_lanes.Clear(width);
  for (int i = 0; i < group.count; ++i) of_lanes.Set(i, parameters, entries);
  of_lanes.In(&in);
  failed.resize(width);
  squares.resize(width);
  states->resize(std::max(0, end - begin_) * 8 * (1 + columns) * width);
  LaneOutputs out;
  out.failed = failed.data();
  out.squares = squares.data();
  out.states = states->data();
  group.tables.Roll(in, LaneSums::kStates, out);
  bool inside = true;
  for (int i = 0; i < group.count; ++i) {
    inside_[group.first + i] = failed[i] == 0.0;
    inside = inside && failed[i] == 0.0;
  }
  return inside;
}

const SceneRollouts::Group& SceneRollouts::GroupOf(int scene) const {
  return *std::find_if(groups_.begin(), groups_.end(),
                       [scene](const Group& g) { return scene < g.first + g.count; });
}

PendulumState<double> SceneRollouts::At(int scene, int frame, int person) const {
  if (groups_.empty()) return paths_[scene].At(std::min(frame, last_[scene]), person);
  const Group& group = GroupOf(scene);
  const int width = group.tables.width();
  const double* const from =
      group.states.data() + (frame - begin_) * 8 * width + scene - group.first;
  PendulumState<double> state;
  for (int i = 0; i < 4; ++i) {
    state.q[i] = from[i * width];
    state.qd[i] = from[(4 + i) * width];
  }
  return state;
}

void SceneRollouts::DerivativesAt(int scene, int frame, int person,
                                  RowMajorMatrix* by_column) const {
  if (groups_.empty()) {
    *by_column = sensitivities_[scene].At(frame, person);
    return;
  }
  const Group& group = GroupOf(scene);
  const int width = group.tables.width();
  const double* from = group.derivatives.data() +
                       ((frame - begin_) * (1 + columns_) + 1) * 8 * width + scene - group.first;
  by_column->resize(8, columns_);
  for (int column = 0; column < columns_; ++column) {
    for (int i = 0; i < 8; ++i, from += width) (*by_column)(i, column) = *from;
  }
}

}  // namespace pushid
