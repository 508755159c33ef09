// ident: what a problem knows of a point, and its parameter blocks and residual blocks.
#include "ident/problem/fit_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/residual_families.h"
#include "residuals/cost_functions/lane_group.h"

namespace pushid {

FitProblem::FitProblem(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
                       std::vector<int> counts)
    : recordings_(recordings),
      options_(options),
      counts_(std::move(counts)),
      map_(options.table.Map()) {
  map_.pool_by = options.pool_by;
  if (options.model.learned != nullptr && !options.hold_network) {
    map_.num_weights = static_cast<int>(options.model.learned->weights.size());
  }
}

FitPoint FitProblem::NominalPoint() const {
  FitPoint point;
  for (const FittedParameter& f : map_.fitted) {
    point.shared.push_back(ToFitted(f.transform, options_.table[f.parameter].nominal));
  }
  for (size_t i = 0; i < recordings_.size(); ++i) {
    const PendulumRecording& recording = recordings_[i];
    if (map_.num_deviations > 0) {
      for (const std::string& unit : PoolingUnits(recording, map_.pool_by)) {
        const auto start = options_.start_deviations.find(unit);
        // Of options that pool something else since, those starts mean other parameters.
        const bool known = start != options_.start_deviations.end() &&
                           static_cast<int>(start->second.size()) == map_.num_deviations;
        point.unit[unit] = known ? start->second : std::vector<double>(map_.num_deviations, 0.0);
      }
    }
    if (recording.initial_velocity != InitialVelocity::kFree) continue;
    std::vector<double>& velocity = point.velocity[static_cast<int>(i)];
    for (const ScenePerson& person : recording.scene.people) {
      velocity.insert(velocity.end(), person.start.qd.data(), person.start.qd.data() + 4);
    }
  }
  if (map_.num_weights > 0) point.weights = options_.model.learned->weights;
  return point;
}

std::optional<FitPoint> FitProblem::PointAt(std::vector<double> row) const {
  FitPoint point = NominalPoint();
  const size_t size = point.Flat().size();
  if (row.size() + point.weights.size() == size) {
    row.insert(row.end(), point.weights.begin(), point.weights.end());
  }
  if (row.size() != size) return std::nullopt;
  point.SetFlat(row);
  return point;
}

ParameterSet<double> FitProblem::Parameters(const FitPoint& point, const std::string& unit) const {
  const auto found = point.unit.find(unit);
  return map_.Apply<double>(point.shared.data(),
                            found == point.unit.end() ? nullptr : found->second.data());
}

ModelOptions FitProblem::ModelAt(const FitPoint& point) const {
  ModelOptions model = options_.model;
  if (map_.num_weights == 0) return model;
  LearnedTerms network = *model.learned;
  network.weights = point.weights;
  model.learned = std::make_shared<const LearnedTerms>(std::move(network));
  return model;
}

Behaviour FitProblem::BehaviourAt(const FitPoint& point) const {
  const ModelOptions model = ModelAt(point);
  Behaviour all;
  for (const std::string& unit : SettlingUnits(point)) {
    const Behaviour one = ComputeBehaviour(model, Parameters(point, unit));
    if (unit.empty()) {
      all = one;
    } else {
      all.Add(one, unit);
    }
  }
  return all;
}

std::vector<std::string> FitProblem::SettlingUnits(const FitPoint& point) const {
  std::vector<std::string> units = {""};
  ModelOptions measured = options_.model;  // as the simulations' pushes are: without a tail
  measured.push_tail = PushTail::kNone;
  const bool differ =
      std::any_of(map_.fitted.begin(), map_.fitted.end(), [&measured](const FittedParameter& f) {
        return f.deviation >= 0 && Acts(f.parameter, measured);
      });
  if (!differ || !HoldsForRecording(map_.pool_by)) return units;
  for (const auto& [unit, deviations] : point.unit) units.push_back(unit);
  return units;
}

LikelihoodProblem FitProblem::LikelihoodOf(int recording, double weight) const {
  return MakeLikelihoodProblem(options_.likelihood, recordings_[recording], options_.model, map_,
                               weight, options_.seed);
}

Deviance FitProblem::DevianceAt(const FitPoint& point) const {
  Deviance sum;
  FitPoint copy = point;
  for (int i = 0; i < static_cast<int>(recordings_.size()); ++i) {
    const LikelihoodProblem problem = LikelihoodOf(i, 1.0);
    const std::vector<double*> blocks = RecordingBlocks(&copy, i);
    const Deviance one =
        DevianceOf(problem, problem.layout.Parameters<double>(map_, blocks.data()));
    sum.value += Count(i) * one.value;
    sum.measured += Count(i) * one.measured;
  }
  return sum;
}

double FitProblem::DataCost(const FitPoint& point) const {
  if (options_.likelihood != Likelihood::kTrajectory) return 0.5 * DevianceAt(point).value;
  FitPoint copy = point;
  double cost = 0.0;
  for (int i = 0; i < static_cast<int>(recordings_.size()); ++i) {
    if (Count(i) == 0) continue;
    const auto rollout =
        MakeRolloutProblem(recordings_[i], options_.model, map_, options_.sigmas, Weight(i, 0), 0);
    Eigen::VectorXd values(rollout->num_residuals());
    if (!RolloutResiduals(*rollout, RecordingBlocks(&copy, i).data(), values.data())) {
      return std::numeric_limits<double>::infinity();
    }
    cost += 0.5 * values.squaredNorm();
  }
  return cost;
}

std::vector<FailedRollout> FitProblem::Failures(const FitPoint& point, int horizon) const {
  std::vector<FailedRollout> failures;
  if (options_.likelihood != Likelihood::kTrajectory) return failures;  // rolls nothing out
  FitPoint copy = point;
  const int total = static_cast<int>(recordings_.size());
  std::vector<std::shared_ptr<const RolloutProblem>> problems(total);
  std::vector<const RolloutProblem*> in_lanes(total, nullptr);
  std::vector<std::vector<double*>> blocks(total);
  for (int i = 0; i < total; ++i) {
    if (Count(i) == 0) continue;
    problems[i] = MakeRolloutProblem(recordings_[i], options_.model, map_, options_.sigmas, 1.0,
                                     Frames(i, horizon));
    blocks[i] = RecordingBlocks(&copy, i);
    if (HasLanes(*problems[i])) in_lanes[i] = problems[i].get();
  }
  std::vector<bool> stays(total, false);  // within the domain, as far as is known
  for (const SideBySide& group : PutSideBySide(in_lanes)) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(blocks[i].data());
    const std::vector<RolloutSums> sums = group.lanes.Evaluate(at, LaneSums::kSquares);
    for (size_t k = 0; k < sums.size(); ++k) stays[group.members[k]] = sums[k].ok;
  }
  for (int i = 0; i < total; ++i) {
    if (problems[i] == nullptr || stays[i]) continue;
    SensitivityInputs inputs;
    RolloutPath<double> path;
    const RolloutStatus status =
        RollOut(*problems[i], blocks[i].data(), Derivatives::kNone, &inputs, &path, nullptr);
    if (!status.ok) failures.push_back({i, status});
  }
  return failures;
}

std::vector<double> FitProblem::RawResiduals(const FitPoint& point, int recording) const {
  FitPoint copy = point;
  ResidualSigmas plain = options_.sigmas;
  plain.robust = 0.0;
  const auto rollout =
      MakeRolloutProblem(recordings_[recording], options_.model, map_, plain, 1.0, 0);
  std::vector<double> values(rollout->num_residuals());
  if (!RolloutResiduals(*rollout, RecordingBlocks(&copy, recording).data(), values.data())) {
    values.clear();
  }
  return values;
}

std::vector<double*> FitProblem::RecordingBlocks(FitPoint* point, int recording) const {
  std::vector<double*> blocks = {point->shared.data()};
  const BlockLayout layout(map_, PoolingUnits(recordings_[recording], map_.pool_by), false);
  if (map_.num_deviations > 0) {
    for (const std::string& unit : layout.units) blocks.push_back(point->unit[unit].data());
  }
  const auto velocity = point->velocity.find(recording);
  if (velocity != point->velocity.end()) blocks.push_back(velocity->second.data());
  if (map_.num_weights > 0) blocks.push_back(point->weights.data());
  return blocks;
}

int PushFrame(const PendulumRecording& recording) {
  int first = recording.num_frames();
  for (const ScenePush& push : recording.scene.pushes) first = std::min(first, push.start_frame);
  return recording.scene.pushes.empty() ? 0 : first;
}

double FitProblem::Weight(int recording, int horizon) const {
  const double counted = std::sqrt(static_cast<double>(Count(recording)));
  if (options_.likelihood != Likelihood::kTrajectory) return counted;
  if (options_.recording_weight == RecordingWeight::kFrame) return counted;
  if (options_.recording_weight == RecordingWeight::kEffective && options_.effective_weight > 0.0) {
    return counted * std::sqrt(options_.effective_weight);
  }
  // A recording's frames are far from independent: together they count as one.
  const PendulumRecording& r = recordings_[recording];
  const int all = r.num_frames(),
            frames = horizon > 0 ? std::min(Frames(recording, horizon), all) : all;
  return counted / std::sqrt(std::max(1, frames - 1));
}

void FitProblem::Built::Add(std::unique_ptr<ceres::CostFunction> cost,
                            const std::vector<double*>& on, int cluster) {
  const ceres::CostFunction* const added = cost.get();
  blocks.push_back({problem->AddResidualBlock(cost.release(), nullptr, on), cluster, added});
}

void FitProblem::Built::AddRollout(std::unique_ptr<ceres::CostFunction> cost,
                                   const std::vector<double*>& on, int cluster) {
  const ceres::CostFunction* const inside = cost.get();
  Add(evaluation->Wrap(std::move(cost), on), on, cluster);
  blocks.back().cost = inside;
}

// Parameters with bounds make Ceres search along every step: it asks for the same point three
// times, twice with derivatives. Rollouts are evaluated once and remembered, whatever the threads.
void FitProblem::AddParameterBlocks(FitPoint* point, int num_threads, Built* built) const {
  built->evaluation = std::make_unique<ParallelEvaluation>(num_threads);
  ceres::Problem::Options problem;
  problem.evaluation_callback = built->evaluation.get();
  built->problem = std::make_unique<ceres::Problem>(problem);
  built->evaluation->set_problem(built->problem.get());
  auto add = [built](std::vector<double>* values) {
    built->problem->AddParameterBlock(values->data(), static_cast<int>(values->size()));
    built->parameter_blocks.push_back(values->data());
  };
  add(&point->shared);
  for (auto& [name, values] : point->unit) add(&values);
  for (auto& [index, values] : point->velocity) add(&values);
  if (map_.num_weights > 0) add(&point->weights);
  for (size_t i = 0; i < map_.fitted.size(); ++i) {
    const ParameterSpec& spec = options_.table[map_.fitted[i].parameter];
    const int index = static_cast<int>(i);
    built->problem->SetParameterLowerBound(point->shared.data(), index,
                                           ToFitted(spec.transform, spec.lower));
    built->problem->SetParameterUpperBound(point->shared.data(), index,
                                           ToFitted(spec.transform, spec.upper));
  }
}

// Of a recording in a stage; null where it fails in its very first step: nothing left to compare.
std::shared_ptr<const RolloutProblem> FitProblem::StageRollout(int recording, int horizon,
                                                               const Built& built) const {
  int frames = Frames(recording, horizon);
  for (const FailedRollout& failed : built.shortened) {
    if (failed.recording == recording) frames = failed.status.frame;
  }
  if (frames == 1) return nullptr;
  return MakeRolloutProblem(recordings_[recording], options_.model, map_, options_.sigmas,
                            Weight(recording, horizon), frames);
}

FitProblem::Built FitProblem::BuildStage(const FitStage& stage, FitPoint* point, bool hold_network,
                                         int num_threads) const {
  Built built;
  AddParameterBlocks(point, num_threads, &built);
  const bool rolls = !stage.equation_error && options_.likelihood == Likelihood::kTrajectory;
  if (rolls) built.shortened = Failures(*point, stage.horizon);

  FamilyPlace place{*this, stage, point, &built};
  const auto add = [&](ResidualFamily::Per per) {
    for (const ResidualFamily& family : ResidualFamilies()) {
      if (family.per == per && family.on(options_, stage)) family.add(family, place);
    }
  };
  for (int i = 0; i < static_cast<int>(recordings_.size()); ++i) {
    if (Count(i) == 0) continue;
    place.recording = i;
    if (rolls) place.rollout = StageRollout(i, stage.horizon, built);
    add(ResidualFamily::kRecording);
  }
  add(ResidualFamily::kPoint);
  for (const std::string& unit : SettlingUnits(*point)) {
    place.unit = unit;
    add(ResidualFamily::kUnit);
  }
  if (hold_network && map_.num_weights > 0) {
    built.problem->SetParameterBlockConstant(point->weights.data());
  }
  return built;
}

}  // namespace pushid
