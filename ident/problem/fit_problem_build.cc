// ident: a problem's blocks, put together for Ceres stage by stage; recordings that fail.
#include <ceres/problem.h>

#include "ident/problem/fit_problem.h"

namespace pushid {

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

// A solver asks for the cost of a trial point, and for derivatives at an accepted one. Rollouts are
// evaluated once and remembered, whatever the threads.
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

std::shared_ptr<const FitProblem::LaidOut> FitProblem::LayOut(int horizon) const {
  const std::lock_guard<std::mutex> lock(layouts_->mutex);
  std::shared_ptr<const LaidOut>& kept = layouts_->by_horizon[horizon];
  if (kept != nullptr) return kept;
  auto made = std::make_shared<LaidOut>();
  made->rollouts.resize(recordings().size());
  const bool rolls = options_.likelihood == Likelihood::kTrajectory;  // others roll nothing out
  for (int i = 0; rolls && i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    made->rollouts[i].problem =
        MakeRolloutProblem(recordings()[i], options_.model, map_, options_.sigmas,
                           Weight(i, horizon), Frames(i, horizon));
  }
  made->side_by_side = PutSideBySide(made->rollouts);
  return kept = std::move(made);
}

std::vector<RolloutAt> FitProblem::Rollouts(const LaidOut& laid_out, FitPoint* point) const {
  std::vector<RolloutAt> rollouts = laid_out.rollouts;
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    const RolloutProblem* const problem = rollouts[i].problem.get();
    if (problem != nullptr) rollouts[i].blocks = BlocksOf(point, i, problem->layout);
  }
  return rollouts;
}

namespace {

std::vector<FailedRollout> FailuresOf(const std::vector<RolloutAt>& rollouts,
                                      const std::vector<SideBySide>& side_by_side) {
  std::vector<FailedRollout> failures;
  const std::vector<RolloutSums> sums = SumUp(side_by_side, rollouts, LaneSums::kSquares);
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const auto& [problem, blocks] = rollouts[i];
    if (problem == nullptr || sums[i].ok) continue;
    SensitivityInputs inputs;
    RolloutPath<double> path;
    const RolloutStatus status =
        RollOut(*problem, blocks.data(), Derivatives::kNone, &inputs, &path, nullptr);
    if (!status.ok) failures.push_back({static_cast<int>(i), status});
  }
  return failures;
}

}  // namespace

std::vector<FailedRollout> FitProblem::Failures(const FitPoint& point, int horizon) const {
  FitPoint copy = point;
  const std::shared_ptr<const LaidOut> laid_out = LayOut(horizon);
  return FailuresOf(Rollouts(*laid_out, &copy), laid_out->side_by_side);
}

FitProblem::Built FitProblem::Build(FitPoint* point, int horizon, bool hold_network,
                                    int num_threads, bool all_inside) const {
  Built built;
  AddParameterBlocks(point, num_threads, &built);
  const std::shared_ptr<const LaidOut> laid_out = LayOut(horizon);
  built.rollouts = Rollouts(*laid_out, point);
  built.side_by_side = {laid_out, &laid_out->side_by_side};
  if (!all_inside) built.shortened = FailuresOf(built.rollouts, *built.side_by_side);
  for (const auto& [recording, status] : built.shortened) {
    std::shared_ptr<const RolloutProblem>& rollout = built.rollouts[recording].problem;
    auto shorter = std::make_shared<RolloutProblem>(*rollout);
    shorter->horizon = status.frame;
    rollout = status.frame == 1 ? nullptr : std::move(shorter);  // nothing is left to compare
  }
  if (!built.shortened.empty()) {
    built.side_by_side =
        std::make_shared<const std::vector<SideBySide>>(PutSideBySide(built.rollouts));
  }
  built.evaluation->set_side_by_side(built.side_by_side);

  FamilyPlace place{*this, point, &built};
  const auto add = [&](ResidualFamily::Per per) {
    for (const ResidualFamily& family : ResidualFamilies()) {
      if (family.per == per && family.on(options_, horizon)) family.add(family, place);
    }
  };
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    place.recording = i;
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
