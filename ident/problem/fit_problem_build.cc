// ident: the parameter blocks and residual blocks of a problem.
#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "residuals/cost_functions/body_residual.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/cost_functions/equation_error_residual.h"
#include "residuals/cost_functions/prior_residual.h"
#include "residuals/cost_functions/rest_residual.h"

namespace pushid {
namespace {

constexpr double kStagePrior = 5.0;  // factor on a log scale, multiple on the others

}  // namespace

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

void FitProblem::AddPriors(FitPoint* point, Built* built) const {
  const int size = static_cast<int>(point->shared.size());
  for (int i = 0; i < size; ++i) {
    const ParameterSpec& spec = options_.table[map_.fitted[i].parameter];
    if (!spec.prior) continue;
    const double sigma = spec.prior->sigma / TransformSlope(spec.transform, spec.prior->mean);
    built->Add(
        std::make_unique<PriorResidual>(size, i, ToFitted(spec.transform, spec.prior->mean), sigma),
        {point->shared.data()}, kPriorCluster);
  }
  for (auto& [name, values] : point->unit) {
    for (const FittedParameter& f : map_.fitted) {
      if (f.deviation < 0) continue;
      built->Add(std::make_unique<PriorResidual>(map_.num_deviations, f.deviation, 0.0,
                                                 PoolingSigma(options_.table[f.parameter])),
                 {values.data()}, kPoolingCluster);
    }
  }
  if (map_.num_weights > 0 && options_.network_prior > 0.0) {
    built->Add(std::make_unique<RidgeResidual>(map_.num_weights, options_.network_prior),
               {point->weights.data()}, kNetworkCluster);
  }
}

// A stage of few frames says nothing of some parameters: what has no prior gets one, so that
// it does not move to its bounds, from which later stages may not return.
void FitProblem::AddStagePriors(FitPoint* point, Built* built) const {
  const int size = static_cast<int>(point->shared.size());
  for (int i = 0; i < size; ++i) {
    const ParameterSpec& spec = options_.table[map_.fitted[i].parameter];
    if (spec.prior) continue;
    const double sigma = spec.transform == Transform::kIdentity
                             ? kStagePrior * std::max(std::abs(spec.nominal), spec.scale)
                             : std::log(kStagePrior);
    built->Add(
        std::make_unique<PriorResidual>(size, i, ToFitted(spec.transform, spec.nominal), sigma),
        {point->shared.data()}, kPriorCluster);
  }
}

void FitProblem::AddRest(FitPoint* point, Built* built) const {
  auto add = [built](std::unique_ptr<ceres::CostFunction> residual,
                     const std::vector<double*>& blocks) {
    std::vector<double> values(residual->num_residuals());
    if (!residual->Evaluate(blocks.data(), values.data(), nullptr)) {
      ++built->rests_left_out;  // Ceres cannot start from a block that fails
      return;
    }
    built->AddRollout(std::move(residual), blocks, kSettlingCluster);
  };
  for (const std::string& unit : SettlingUnits(*point)) {
    std::vector<double*> blocks = {point->shared.data()};
    if (!unit.empty()) blocks.push_back(point->unit[unit].data());
    std::vector<double*> rollout_blocks = blocks;
    if (map_.num_weights > 0) rollout_blocks.push_back(point->weights.data());
    const auto settle = [&](double mass, double impulse, int people) {
      add(std::make_unique<SettlingResidual>(
              MakeSettlingProblem(SettlingScene(mass, impulse, people), options_.model, map_,
                                  options_.settling_weight, unit)),
          rollout_blocks);
    };
    if (options_.settling_weight > 0.0) {
      for (double impulse : kSettlingImpulses) settle(kSettlingMasses[0], impulse, 1);
      if (options_.model.interaction.Any()) {
        for (double impulse : kLineImpulses) settle(kSettlingMass, impulse, kLinePeople);
      }
    }
    if (options_.mode_weight > 0.0) {
      const Body body = SettlingScene(kSettlingMass, 0.0).people[0].body;
      built->Add(
          std::make_unique<ModalStabilityResidual>(options_.model, body, map_, options_.mode_margin,
                                                   options_.mode_weight, !unit.empty()),
          blocks, kSettlingCluster);
    }
  }
}

FitProblem::Built FitProblem::Build(FitPoint* point, int horizon, bool hold_network,
                                    int num_threads) const {
  Built built;
  AddParameterBlocks(point, num_threads, &built);
  if (options_.likelihood == Likelihood::kTrajectory) {
    AddRollouts(point, horizon, &built);
  } else {
    AddLikelihoods(point, &built);
  }
  AddPriors(point, &built);
  // The settling simulations are long rollouts: they join once the horizon is as long.
  if (horizon == 0) {
    AddRest(point, &built);
  } else {
    AddStagePriors(point, &built);
  }
  if (hold_network && map_.num_weights > 0) {
    built.problem->SetParameterBlockConstant(point->weights.data());
  }
  return built;
}

void FitProblem::AddRollouts(FitPoint* point, int horizon, Built* built) const {
  built->shortened = Failures(*point, horizon);
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    int frames = horizon;
    for (const FailedRollout& failed : built->shortened) {
      if (failed.recording == i) frames = failed.status.frame;
    }
    if (Count(i) == 0) continue;
    if (frames == 1) continue;  // fails in its very first step: nothing left to compare
    const auto rollout = MakeRolloutProblem(recordings()[i], options_.model, map_, options_.sigmas,
                                            Weight(i, horizon), frames);
    built->AddRollout(std::make_unique<CondensedRollout>(rollout, options_.jacobian),
                      RecordingBlocks(point, i), i);
    // Bodies join once the path is there: their joints follow the path before and after a frame.
    // A fit has those of all recordings (PrepareFit); what was read from a file, and a design's
    // recordings that are still to be made, have none, and are seen by their pendulums alone.
    if (horizon != 0 || options_.body_weight <= 0.0 || options_.body == nullptr) continue;
    if (options_.body->motions.count(recordings()[i].id) == 0) continue;
    built->AddRollout(std::make_unique<BodyResidual>(rollout, options_.body, options_.body_weight),
                      RecordingBlocks(point, i), i);
  }
}

void FitProblem::AddLikelihoods(FitPoint* point, Built* built) const {
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    const std::vector<double*> blocks = RecordingBlocks(point, i);
    auto residual = std::make_unique<LikelihoodResidual>(
        LikelihoodOf(i, Weight(i, 0)), blocks.data(),
        options_.jacobian == JacobianMethod::kAutodiff, fall_of_noise_);
    if (!residual->status().ok) {
      built->shortened.push_back({i, residual->status()});
      continue;
    }
    built->offsets[i] = Count(i) * residual->offset();
    built->AddRollout(std::move(residual), blocks, i);
  }
}

FitProblem::Built FitProblem::BuildEquationError(FitPoint* point) const {
  Built built;
  AddParameterBlocks(point, 1, &built);
  for (int i = 0; i < static_cast<int>(recordings().size()); ++i) {
    if (Count(i) == 0) continue;
    auto residual = std::make_unique<EquationErrorResidual>(recordings()[i], options_.model, map_);
    built.AddRollout(std::move(residual), RecordingBlocks(point, i), i);
  }
  AddPriors(point, &built);
  if (map_.num_weights > 0) built.problem->SetParameterBlockConstant(point->weights.data());
  return built;
}

}  // namespace pushid
