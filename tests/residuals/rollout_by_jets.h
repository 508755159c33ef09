// All rows of a rollout by Jets through it: the oracle of the sensitivities.
#pragma once

#include <ceres/cost_function.h>

#include <memory>

#include "residuals/cost_functions/rollout_problem.h"

namespace pushid {

// Compiled once, in its source file: it takes the compiler as long as everything else of this
// folder.
std::unique_ptr<ceres::CostFunction> RolloutByJets(std::shared_ptr<const RolloutProblem> problem);

// The residuals, for ceres::DynamicAutoDiffCostFunction.
struct RolloutResidualFunctor {
  std::shared_ptr<const RolloutProblem> problem;

  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const RolloutProblem& p = *problem;
    const Scene& scene = p.recording->scene;
    std::vector<Vector4<T>> velocities;
    for (const ScenePerson& person : scene.people) {
      velocities.push_back(person.start.qd.template cast<T>());
    }
    if (const T* free = p.layout.VelocityBlock(blocks)) {
      for (int n = 0; n < scene.num_people(); ++n) {
        velocities[n] = Eigen::Map<const Vector4<T>>(free + 4 * n);
      }
    }
    RolloutPath<T> path;
    const std::vector<ParameterSet<T>> parameters = p.layout.Parameters<T>(p.map, blocks);
    if (!Rollout<T>(scene, p.options, parameters, velocities, p.horizon, &path, nullptr,
                    p.layout.WeightBlock(blocks))
             .ok) {
      return false;
    }
    for (int t = 1; t < p.horizon; ++t) {
      for (int n = 0; n < scene.num_people(); ++n, residuals += kFrameResiduals) {
        Eigen::Map<FrameVector<T>> r(residuals);
        const PendulumState<T>& state = path.At(t, n);
        const Body& body = scene.people[n].body;
        r = T(p.weight) * (RodMoves(p.options)
                               ? FrameResidual<T>(BodyNow(body, state.rod, parameters[n][kRodLift]),
                                                  state, p.Measured(t, n), p.sigmas)
                               : FrameResidual<T>(body, state, p.Measured(t, n), p.sigmas));
      }
    }
    const std::vector<int> on_plates = p.PeopleOnPlates();
    const std::vector<BodyOnPlates<T>> bodies = BodiesOnPlates<BodyOnPlates<T>>(p, parameters);
    for (int t = 0; t + 1 < p.horizon; ++t) {
      for (size_t k = 0; k < on_plates.size(); ++k) {
        const int n = on_plates[k];
        Eigen::Map<PlateVector<T>> r(residuals);
        r = T(p.weight) * PlateResidual<T>({&scene, &p.options, n, t}, bodies[k], parameters[n],
                                           path.At(t, n), path.At(t + 1, n).qd,
                                           p.recording->plates[n][t], p.sigmas);
        residuals += kPlateResiduals;
      }
    }
    return true;
  }
};

}  // namespace pushid
