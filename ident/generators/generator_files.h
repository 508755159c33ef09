// ident: a generator in a folder: generator.json (what it is, what it was trained on) and
// weights.npy. Both load without the training code and without LibTorch; tensor_folder.h has the
// layout. Settings of every kind: which data it is for, frames observed and forecast, the rate, the
// particles; then its own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/json_file.h"
#include "ident/generators/generator_kinds.h"
#include "models/generators/diffusion_generator.h"
#include "models/generators/particle_generator.h"
#include "models/generators/simlpe_network.h"
#include "models/push.h"
#include "models/restoration/restoration.h"

namespace pushid {

// What a generator forecasts: motion-capture clips, or recordings of pushes.
enum class GeneratorData { kCmu, kPushes };
constexpr EnumNames<GeneratorData, 2> Names(GeneratorData) {
  return {{{"cmu", GeneratorData::kCmu}, {"pushes", GeneratorData::kPushes}}};
}

// Who forecasts best, as cross-validation found: the generator, `blend` of the way to physics, or
// physics with restored bodies.
enum class ForecastBy { kGenerator, kRestoration };
constexpr EnumNames<ForecastBy, 2> Names(ForecastBy) {
  return {{{"generator", ForecastBy::kGenerator}, {"restoration", ForecastBy::kRestoration}}};
}
struct ForecastChoice {
  ForecastBy by = ForecastBy::kGenerator;
  double blend = 0.0;
};
// Beside the generator in its folder, where there was a choice.
inline constexpr const char* kChosenPhysics = "physics.json";
inline constexpr const char* kChosenRestoration = "restoration";

struct GeneratorSettings {
  GeneratorData data = GeneratorData::kCmu;
  int observed = 25;                      // frames that it is given
  int predicted = 25;                     // frames that it was trained to forecast
  double rate = 25.0;                     // Hz
  bool pendulum = false;                  // whether it must be told where physics have the hips
  std::vector<PushKind> push_kinds = {};  // of the pushes learned from; empty: not known
  ParticleLayout layout;
  std::optional<ForecastChoice> choice;  // none: nothing was compared
  KeptJson training{};                   // provenance
};

struct TrainedNetworks {
  GeneratorSettings settings;
  SharedNetworks of_kind;

  GeneratorKind kind() const { return of_kind->kind(); }
};

// Frames that physics beside a generator see, as it does (one is the first, which everybody has);
// 0 where physics go into the network: then they start at frame 0, as in its training.
inline int ShownToPhysics(const GeneratorSettings& settings) {
  return settings.observed > 1 && !settings.pendulum ? settings.observed : 0;
}

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained);

struct LoadedGenerator {
  GeneratorKind kind = GeneratorKind::kParticles;
  GeneratorSettings settings;
  std::unique_ptr<MotionGenerator> generator;
  std::unique_ptr<Restoration> restoration;  // that forecasts in its place; usually none
};

// flag: what names the folder, for messages. Errors: no such folder, settings or tensors that are
// missing or do not fit.
Result<LoadedGenerator> LoadGenerator(const std::string& folder,
                                      const GeneratorChanges& changes = {},
                                      const char* flag = "--model");

// The same of what was just trained.
std::unique_ptr<MotionGenerator> MakeGenerator(const TrainedNetworks& trained,
                                               const GeneratorChanges& changes = {});

// The networks of each kind of generator, as its trainer leaves them and its file holds
// them.

struct TrainedParticles : KindNetworks {
  std::vector<ParticleNetwork> members;  // of one structure
  BlendPartners partners;
  double ridge_share = 0.0, simlpe_share = 0.0;
  double jitter = 0.0;  // of the pose in training, and in sampled futures

  GeneratorKind kind() const override { return GeneratorKind::kParticles; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override;
  MaybeError Check(const GeneratorChanges& changes) const override;
  std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                        const GeneratorChanges& changes) const override;
};

struct TrainedSimlpe : KindNetworks {
  std::vector<SimlpeNetwork> members;  // of as many blocks each

  GeneratorKind kind() const override { return GeneratorKind::kSimlpe; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override { return TensorsOf(members); }
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
