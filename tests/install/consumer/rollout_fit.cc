// With an installed pushid and Ceres alone: eight parameters of 32 pushed people, one autodiff
// residual block per recording. What pushid-fit adds are weights from the data, settling, pooling
// and a verdict.
//
//   rollout_fit fzj_push/manifest.json
#include <ceres/ceres.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "datasets/loading/load_recordings.h"
#include "ident/parameters/presets.h"
#include "residuals/jets/autodiff_rollout.h"

using namespace pushid;

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::exists(argv[1])) {
    std::puts("skipped: the recordings are not here");
    return 0;
  }
  LoadOptions single;
  single.setting = "single";
  const auto loaded = LoadRecordings(argv[1], single);
  if (!loaded.ok()) return std::fprintf(stderr, "%s\n", loaded.error().ToString().c_str()), 1;
  const std::vector<PendulumRecording> recordings = MakePendulumRecordings(loaded.value());

  // What is fitted, and on which scale; everything else stays at the preset's values.
  const FitOptions tail = MakePreset("tail").value();
  ParameterMap map;
  std::vector<double> shared;
  for (const ParameterSpec& spec : tail.table.specs) {
    map.values[spec.id] = spec.nominal;
    if (!spec.free) continue;
    map.fitted.push_back({spec.id, spec.transform});
    shared.push_back(ToFitted(spec.transform, spec.nominal));
  }

  ceres::Problem problem;
  for (const PendulumRecording& recording : recordings) {
    const auto rollout = MakeRolloutProblem(recording, tail.model, map, tail.sigmas, 1.0, 0);
    auto* cost = new ceres::DynamicAutoDiffCostFunction<RolloutResidual, 8>(
        new RolloutResidual{rollout});  // or AutoDiffRollout(rollout), five times as fast
    for (int size : rollout->layout.BlockSizes()) cost->AddParameterBlock(size);
    cost->SetNumResiduals(rollout->num_residuals());
    problem.AddResidualBlock(cost, nullptr, shared.data());
  }
  ceres::Solver::Options options;
  options.max_num_iterations = 100;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::puts(summary.BriefReport().c_str());
  for (size_t i = 0; i < shared.size(); ++i) {
    const FittedParameter& f = map.fitted[i];
    std::printf("%-16s %.4g\n", tail.table.specs[f.parameter].name.c_str(),
                ToNatural(f.transform, shared[i]));
  }
  return summary.IsSolutionUsable() && summary.final_cost < summary.initial_cost ? 0 : 1;
}
