// ident: the networks of each kind of generator, as its trainer leaves them and its file holds
// them.
#pragma once

#include <vector>

#include "ident/generators/generator_kinds.h"

namespace pushid {

struct TrainedParticles : KindNetworks {
  std::vector<ParticleNetwork> members;  // of one structure
  RidgeForecast ridge;                   // empty where ridge_share is 0
  double ridge_share = 0.0;
  double jitter = 0.0;  // of the pose in training, and in sampled futures

  GeneratorKind kind() const override { return GeneratorKind::kParticles; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override;
  MaybeError Check(const GeneratorChanges& changes) const override;
  std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                        const GeneratorChanges& changes) const override;
};

struct TrainedDiffusion : KindNetworks {
  std::vector<DiffusionNetwork> members;  // of one structure

  GeneratorKind kind() const override { return GeneratorKind::kDiffusion; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override { return TensorsOf(members); }
  std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                        const GeneratorChanges& changes) const override;
};

}  // namespace pushid
