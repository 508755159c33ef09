// residuals: settling by rollouts with derivatives.
#include "residuals/cost_functions/rest_residual.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "residuals/rollout_residual.h"

namespace pushid {
namespace {

constexpr double kWatched = 1.0;  // s, of settled people
constexpr double kMet = 0.9;      // of what counts as settled: where the hinge begins
constexpr int kSettlingRows = 3;  // for each frame and person

using SettlingRows = Eigen::Matrix<double, kSettlingRows, 8>;  // residuals by [q, qd]

// max(0, |v| / limit - 1) and its derivative by v.
template <int kSize>
double Hinge(const Eigen::Matrix<double, kSize, 1>& v, double limit,
             Eigen::Matrix<double, 1, kSize>* slope) {
  const double size = v.norm(), x = size / limit - 1.0;
  *slope = x > 0.0 ? (v / (size * limit)).transpose().eval() : slope->Zero();
  return std::max(0.0, x);
}

// The residuals of one frame and person, unweighted, and (where by_state is given) their
// derivatives by [q, qd].
void SettlingOf(const PendulumState<double>& state, const SelfForce& self, double* residuals,
                SettlingRows* by_state) {
  Eigen::Matrix<double, 1, 2> by_velocity;
  Eigen::Matrix<double, 1, 1> by_angle[2];
  residuals[0] = Hinge<2>(state.qd.head<2>(), kMet * kSettledSpeed, &by_velocity);
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Matrix<double, 1, 1> lean(state.q[2 + axis] - self.posture[axis]);
    residuals[1 + axis] = Hinge<1>(lean, kMet * kSettledLean, &by_angle[axis]);
  }
  if (by_state == nullptr) return;
  by_state->setZero();
  by_state->block<1, 2>(0, 4) = by_velocity;
  for (int axis = 0; axis < 2; ++axis) (*by_state)(1 + axis, 2 + axis) = by_angle[axis](0);
}

}  // namespace

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
    Group group{LaneTables(lanes, tails, steps), first, count, {}, {}};
    for (int i = 0; i < count; ++i) group.tables.Set(i, scenes_[first + i], options_, end_);
    groups_.push_back(std::move(group));
    first += count;
  }
}

bool SceneRollouts::Roll(const std::vector<ParameterSet<double>>& parameters,
                         const double* network_weights) {
  for (Group& group : groups_) RollGroup({parameters[0], {}}, 0, end_, group, &group.states);
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
    if (!RollGroup({inputs.parameters[0], inputs.entries[0]}, columns, most, group,
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

bool SceneRollouts::RollGroup(const LanePerson& person, int columns, int end, const Group& group,
                              LaneResults* results) {
  LaneRequest request;
  request.frames = end;
  request.first_state = begin_;
  request.columns = columns;
  group.tables.Roll(request, std::vector<LanePerson>(group.count, person), results);
  bool inside = true;
  for (int i = 0; i < group.count; ++i) {
    inside_[group.first + i] = results->failed[i] == 0.0;
    inside = inside && inside_[group.first + i];
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
      group.states.states.data() + (frame - begin_) * 8 * width + scene - group.first;
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
  const double* from = group.derivatives.states.data() +
                       ((frame - begin_) * (1 + columns_) + 1) * 8 * width + scene - group.first;
  by_column->resize(8, columns_);
  for (int column = 0; column < columns_; ++column) {
    for (int i = 0; i < 8; ++i, from += width) (*by_column)(i, column) = *from;
  }
}

SettlingProblem MakeSettlingProblem(const std::vector<Scene>& scenes, const ModelOptions& options,
                                    const ParameterMap& map, double weight,
                                    const std::string& unit) {
  SettlingProblem problem;
  problem.scenes = scenes;
  problem.options = options;
  problem.map = map;
  // No particular person: only the shared block.
  if (unit.empty()) problem.map.num_deviations = 0;
  const std::vector<std::string> units(scenes[0].people.size(), unit);
  problem.layout = BlockLayout(problem.map, units, false);
  problem.weight = weight;
  problem.first_frame = scenes[0].SettledFrame(options);
  problem.last_frame = problem.first_frame + static_cast<int>(std::lround(kWatched / scenes[0].dt));
  return problem;
}

SettlingResidual::SettlingResidual(SettlingProblem problem)
    : problem_(std::move(problem)),
      rollouts_(problem_.scenes, problem_.options, problem_.first_frame, problem_.last_frame) {
  for (int size : problem_.layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(static_cast<int>(problem_.scenes.size()) *
                    (problem_.last_frame - problem_.first_frame) * problem_.scenes[0].num_people() *
                    kSettlingRows);
}

bool SettlingResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const SettlingProblem& p = problem_;
  const SensitivityInputs inputs = RolloutInputs(p.scenes[0], p.map, p.layout, blocks);
  const int people = p.scenes[0].num_people(), scenes = static_cast<int>(p.scenes.size());
  std::vector<double> at;
  for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    at.insert(at.end(), blocks[b], blocks[b] + parameter_block_sizes()[b]);
  }
  if (at != rolled_at_) {
    rolled_at_.reset();
    if (!rollouts_.Roll(inputs.parameters, inputs.network_weights)) return false;
    rolled_at_ = std::move(at);
  }
  const double scale = p.weight / std::sqrt((p.last_frame - p.first_frame) * people);
  struct Slope {
    int scene, frame, person, row;
    SettlingRows by_state;
  };
  std::vector<Slope> slopes;           // where there are any
  std::vector<int> frames(scenes, 0);  // to which they are asked for
  SettlingRows by_state;
  int row = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const std::vector<SelfForce> self = SelfForces(p.scenes[scene], p.options);
    for (int t = p.first_frame; t < p.last_frame; ++t) {
      for (int n = 0; n < people; ++n, row += kSettlingRows) {
        SettlingOf(rollouts_.At(scene, t, n), self[n], residuals + row,
                   jacobians != nullptr ? &by_state : nullptr);
        for (int k = 0; k < kSettlingRows; ++k) residuals[row + k] *= scale;
        if (jacobians == nullptr || by_state.isZero(0.0)) continue;
        slopes.push_back({scene, t, n, row, by_state});
        frames[scene] = t + 1;
      }
    }
  }
  if (jacobians == nullptr) return true;
  for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    if (jacobians[b] == nullptr) continue;
    std::fill_n(jacobians[b], num_residuals() * parameter_block_sizes()[b], 0.0);
  }
  if (slopes.empty()) return true;
  rolled_at_.reset();  // simulations with derivatives end where these do
  if (!rollouts_.Differentiate(inputs, p.layout.num_acting(), frames)) return false;
  const ActingColumns columns(p.layout);
  RowMajorMatrix state, by_column;
  for (const Slope& slope : slopes) {
    rollouts_.DerivativesAt(slope.scene, slope.frame, slope.person, &state);
    by_column = scale * slope.by_state * state;
    columns.Scatter(by_column, slope.row, num_residuals(), jacobians);
  }
  return true;
}

}  // namespace pushid
