// ident: learned generators: their files, and forecasts of recordings.
//
// A generator is a folder with generator.json (settings and training data) and weights.npy, which
// load without LibTorch; restoration_files.h has the layout.
#pragma once

#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/kept_json.h"
#include "datasets/files/names.h"
#include "ident/bodies/body_recording.h"
#include "models/generators/diffusion_generator.h"
#include "models/generators/generator_trainers.h"
#include "models/generators/particle_generator.h"
#include "models/push.h"
#include "models/restoration/trainer.h"

namespace pushid {

// The kinds of generators, one row each.
//
// A new kind is a value and two rows here, a generator and its trainer (models/generators/), a
// class derived from KindNetworks, and the two functions named in the rows (the trainer's is in
// ident/training/). Both programs then accept it as --kind.
//
// There are two tables, because only pushid-train-generator needs LibTorch, and a program links
// everything in the tables it reads.

struct GeneratorSamples;          // ident/training/generator_training.h
struct GeneratorTrainingOptions;  // ident/training/generator_training.h

enum class GeneratorKind { kParticles, kDiffusion };

struct GeneratorSettings {
  int observed = 25;                      // frames
  int predicted = 25;                     // frames that it was trained to forecast
  double rate = 25.0;                     // Hz
  std::vector<PushKind> push_kinds = {};  // of the training recordings; empty: unknown
  ParticleLayout layout;
  KeptJson training{};  // provenance
};

// Settings of a forecast that may differ from the training's. `particles` has no effect on jitter
// and the shares of the blend, which are as trained.
struct GeneratorChanges {
  bool ridge = true, simlpe = true;  // false: left out of the blend
  ParticleGeneratorOptions particles = {};
  DiffusionGeneratorOptions diffusion = {};
  uint64_t seed = 1;  // of the samples averaged in a forecast by diffusion
};

// The networks of a generator, by its kind.
class KindNetworks {
 public:
  virtual ~KindNetworks() = default;
  virtual GeneratorKind kind() const = 0;
  // The settings of this kind, in addition to GeneratorSettings.
  virtual nlohmann::ordered_json Settings() const = 0;
  virtual TensorList Tensors() const = 0;
  virtual std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                                const GeneratorChanges& changes) const = 0;
};
using SharedNetworks = std::shared_ptr<const KindNetworks>;

// settings: as Settings() returns them. Throws nlohmann's exceptions and std::runtime_error.
using GeneratorReader = SharedNetworks(const nlohmann::ordered_json& settings,
                                       const GeneratorSettings& of_all, TensorFields* reader);
GeneratorReader ReadParticles, ReadDiffusion;

struct GeneratorKindRow {
  const char* name;
  GeneratorKind value;
  const char* what;  // for the list of kinds on the command line
  // true: recordings of groups, with any number of observed frames, which may be blended with
  // physics; false: clips of motion capture, one body each.
  bool groups;
  int seeds;          // default number of networks that are averaged
  const char* paper;  // value of --published for its settings
  GeneratorReader* read;
};

inline constexpr GeneratorKindRow kGeneratorKinds[] = {
    {"particles", GeneratorKind::kParticles, "displacements with learned drift and noise", false, 3,
     "sde", ReadParticles},
    {"diffusion", GeneratorKind::kDiffusion, "whole groups of interacting people", true, 1, "sdm",
     ReadDiffusion},
};

constexpr const auto& Names(GeneratorKind) { return kGeneratorKinds; }
static_assert(RowsAreInOrder(kGeneratorKinds), "RowOf finds a row by its value");

// Runs a trainer to its end; called for each seed in turn.
using SeedRunner = std::function<void(Trainer* trainer)>;
// Errors: no training data.
using GeneratorTrainer = Result<SharedNetworks>(const GeneratorSamples& samples,
                                                const GeneratorTrainingOptions& options,
                                                const SeedRunner& run);
GeneratorTrainer TrainParticles, TrainDiffusion;
inline constexpr GeneratorTrainer* kGeneratorTrainers[] = {TrainParticles, TrainDiffusion};

static_assert(std::size(kGeneratorTrainers) == std::size(kGeneratorKinds), "a kind has no trainer");

// Names of the kinds that forecast whole groups, for messages.
inline std::string KindsOfGroups() {
  return AnyName<GeneratorKind>([](const GeneratorKindRow& row) { return row.groups; });
}

struct TrainedNetworks {
  GeneratorSettings settings;
  SharedNetworks of_kind;

  GeneratorKind kind() const { return of_kind->kind(); }
  std::unique_ptr<MotionGenerator> Make(const GeneratorChanges& changes = {}) const {
    return of_kind->Make(settings, changes);
  }
};

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained);

// Errors: no such folder; settings or tensors that are missing or invalid.
Result<TrainedNetworks> ReadGenerator(const std::string& folder);

struct TrainedParticles : KindNetworks {
  std::vector<ParticleNetwork> members;  // of one structure
  BlendPartners partners;
  double ridge_share = 0.0, simlpe_share = 0.0;
  double jitter = 0.0;  // of the pose in training, and in sampled futures

  GeneratorKind kind() const override { return GeneratorKind::kParticles; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override;
  std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                        const GeneratorChanges& changes) const override;
};

struct TrainedDiffusion : KindNetworks {
  std::vector<DiffusionNetwork> members;  // of one structure

  GeneratorKind kind() const override { return GeneratorKind::kDiffusion; }
  nlohmann::ordered_json Settings() const override;
  TensorList Tensors() const override;
  std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                        const GeneratorChanges& changes) const override;
};

// Pushed people as particles: 22 joints, relative to the floor below the hip at frame 0, with the
// push as controls.
//
// People must face +x, the direction of the published pushes, because mirroring changes the sign of
// y. The push of a frame is [Fx, Fy, Ftheta, Fphi] over the mass, in N/kg and N m/kg.

inline constexpr int kPushControls = 4;

ParticleLayout PushLayout(const std::vector<std::string>& joint_names);

// All frames of one person, with the pushes on this person alone.
ObservedMotion ParticlesOf(const BodyRecording& recording, int person);
// The inverse; place: that of ObservedMotion.
BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector2f& place);

// The prediction of physics from as many observed frames as the generator has. Errors: a rollout
// that leaves the model's domain.
Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames = 0);

std::vector<ObservedMotion> GroupOf(const BodyRecording& recording);

// The kinds of a scene's pushes, each once.
std::vector<PushKind> PushKindsOf(const Scene& scene);
// A warning about pushes of kinds that the training did not have; empty: there are none.
std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene);

// The observed frames of a recording, then the generator's forecast to the recording's end, or up
// to `frames` frames in total. physics: predicts the hips for blending; null: no blending. Errors:
// a recording of another rate, or too short; those of PredictBeside.
Result<std::vector<BodyMotion>> GenerateBodies(const GeneratorSettings& settings,
                                               const MotionGenerator& generator,
                                               const BodyRecording& recording,
                                               const IdentifiedModel* physics = nullptr,
                                               int frames = 0);

}  // namespace pushid
