// ident: a generator in a folder: generator.json (what it is, what it was trained on) and
// weights.npy. Both load without the training code and without LibTorch; tensor_folder.h has the
// layout. Settings of every kind: which data it is for, frames observed and forecast, the rate, the
// particles; then its own.
#pragma once

#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/kept_json.h"
#include "ident/parameters/option_names.h"
#include "models/generators/diffusion_generator.h"
#include "models/generators/generator_trainers.h"
#include "models/generators/particle_generator.h"
#include "models/generators/simlpe_network.h"
#include "models/push.h"
#include "models/restoration/restoration.h"
#include "models/restoration/trainer.h"

namespace pushid {

// The kinds of generators, one row each.
//
// A new kind is a value and two rows here, and files of its own: the generator and its trainer
// (models/generators/), a class derived from KindNetworks, the two functions that the rows name
// (the trainer's in ident/training/), and its flags (apps/flags/kind_flags.h). Both programs then
// accept it as --kind.
//
// The tables are two, because nothing but pushid-train-generator needs LibTorch, and a program
// links everything in the tables it reads.

struct GeneratorSettings;         // ident/generators/generator_files.h
struct GeneratorSamples;          // ident/training/generator_training.h
struct GeneratorTrainingOptions;  // ident/training/generator_training.h

enum class GeneratorKind { kParticles, kDiffusion, kSimlpe };

// What may differ from the training; unset: as trained.
struct GeneratorChanges {
  std::optional<double> ridge_share, simlpe_share;
  ParticleGeneratorOptions particles = {};
  DiffusionGeneratorOptions diffusion = {};
  uint64_t seed = 1;  // of the samples that a forecast by diffusion averages
};

// Options of every seed's training, by kind.
struct KindTrainingOptions {
  ParticleTrainingOptions particles;
  DiffusionTrainingOptions diffusion;
  SimlpeTrainingOptions simlpe;
};

// The networks of a generator, by its kind.
class KindNetworks {
 public:
  virtual ~KindNetworks() = default;
  virtual GeneratorKind kind() const = 0;
  // Beside the settings of all kinds.
  virtual nlohmann::ordered_json Settings() const = 0;
  virtual TensorList Tensors() const = 0;
  // Errors: changes that these networks do not allow.
  virtual MaybeError Check(const GeneratorChanges&) const { return std::nullopt; }
  virtual std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                                const GeneratorChanges& changes) const = 0;
};
using SharedNetworks = std::shared_ptr<const KindNetworks>;

// settings: as Settings() says; of_all: what every kind has. Throws nlohmann's exceptions, and
// Demand's where something does not fit.
using GeneratorReader = SharedNetworks(const nlohmann::ordered_json& settings,
                                       const GeneratorSettings& of_all, TensorReader* reader);
GeneratorReader ReadParticles, ReadDiffusion, ReadSimlpe;

struct GeneratorKindRow {
  const char* name;
  GeneratorKind value;
  const char* what;  // for the list of kinds on the command line
  // People of a call see each other: whole groups that are pushed, which physics may blend with.
  // Otherwise it forecasts people one by one, and motion capture too.
  bool groups;
  bool futures;       // more than one can be sampled
  bool any_observed;  // trained for any number of frames shown, so that others may be shown in use
  int observed;       // frames of a push that it is shown, if no flag says otherwise
  int seeds;          // networks that are averaged, likewise
  GeneratorReader* read;
};

inline constexpr GeneratorKindRow kGeneratorKinds[] = {
    {"particles", GeneratorKind::kParticles, "displacements with learned drift and noise", false,
     true, false, 20, 3, ReadParticles},
    {"diffusion", GeneratorKind::kDiffusion, "whole groups of interacting people", true, true, true,
     1, 1, ReadDiffusion},
    {"simlpe", GeneratorKind::kSimlpe, "siMLPe, a perceptron to compare with", false, false, false,
     12, 1, ReadSimlpe},
};

constexpr const auto& Names(GeneratorKind) { return kGeneratorKinds; }
static_assert(RowsAreInOrder(kGeneratorKinds), "RowOf finds a row by its value");

// run: takes the trainer of every seed, in turn, to its end, with checkpoints of this key.
using SeedRunner = std::function<MaybeError(Trainer* trainer, const std::string& key)>;
// Errors: nothing to learn from; those of run.
using GeneratorTrainer = Result<SharedNetworks>(const GeneratorSamples& samples,
                                                const GeneratorTrainingOptions& options,
                                                const SeedRunner& run);
GeneratorTrainer TrainParticles, TrainDiffusion, TrainSimlpe;
inline constexpr GeneratorTrainer* kGeneratorTrainers[] = {TrainParticles, TrainDiffusion,
                                                           TrainSimlpe};

static_assert(std::size(kGeneratorTrainers) == std::size(kGeneratorKinds), "a kind has no trainer");

// Of those that forecast whole groups, for messages.
inline std::string KindsOfGroups() {
  return AnyName<GeneratorKind>([](const GeneratorKindRow& row) { return row.groups; });
}

// For readers of settings.
inline void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}
// How many networks a file has.
int ReadMembers(const nlohmann::ordered_json& json);
// What their tensors are called.
inline constexpr char kMember[] = "member";
inline std::string MemberName(size_t member, const std::string& name = kMember) {
  return name + std::to_string(member);
}
template <typename Network>
void AddMembers(const std::string& name, const std::vector<Network>& members, TensorList* tensors) {
  for (size_t m = 0; m < members.size(); ++m) AddTensors(MemberName(m, name), members[m], tensors);
}
template <typename Network>
TensorList TensorsOf(const std::vector<Network>& members) {
  TensorList tensors;
  AddMembers(kMember, members, &tensors);
  return tensors;
}

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

// Frames that physics beside a generator see, as it does: one is the first, which everybody has.
inline int ShownToPhysics(const GeneratorSettings& settings) {
  return settings.observed > 1 ? settings.observed : 0;
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
