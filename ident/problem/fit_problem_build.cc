// ident: a problem's blocks, put together for Ceres stage by stage.
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

// Of a recording in a stage; null where it fails in its very first step: nothing left to compare.
std::shared_ptr<const RolloutProblem> FitProblem::StageRollout(int recording, int horizon,
                                                               const Built& built) const {
  int frames = Frames(recording, horizon);
  for (const FailedRollout& failed : built.shortened) {
    if (failed.recording == recording) frames = failed.status.frame;
  }
  if (frames == 1) return nullptr;
  return MakeRolloutProblem(recordings()[recording], options_.model, map_, options_.sigmas,
                            Weight(recording, horizon), frames);
}

FitProblem::Built FitProblem::Build(FitPoint* point, int horizon, bool hold_network,
                                    int num_threads, bool all_inside) const {
  Built built;
  AddParameterBlocks(point, num_threads, &built);
  const bool rolls = options_.likelihood == Likelihood::kTrajectory;
  if (rolls && !all_inside) built.shortened = Failures(*point, horizon);

  FamilyPlace place{*this, point, &built};
  const auto add = [&](ResidualFamily::Per per) {
    for (const ResidualFamily& family : ResidualFamilies()) {
      if (family.per == per && family.on(options_, horizon)) family.add(family, place);
    }
  };
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    place.recording = i;
    if (rolls) place.rollout = StageRollout(i, horizon, built);
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
