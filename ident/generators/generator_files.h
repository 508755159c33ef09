// ident: learned generators: their files, and what they make of recordings.
//
// A generator is a folder: generator.json (what it is, what it was trained on) and
// weights.npy. Both load without the training code and without LibTorch; restoration_files.h has
// the layout. Settings of every kind: frames observed and forecast, the rate, the particles; then
// its own.
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
// A new kind is a value and two rows here, and files of its own: the generator and its trainer
// (models/generators/), a class derived from KindNetworks, and the two functions that the rows name
// (the trainer's in ident/training/). Both programs then accept it as --kind.
//
// The tables are two, because nothing but pushid-train-generator needs LibTorch, and a program
// links everything in the tables it reads.

struct GeneratorSamples;          // ident/training/generator_training.h
struct GeneratorTrainingOptions;  // ident/training/generator_training.h

enum class GeneratorKind { kParticles, kDiffusion };

struct GeneratorSettings {
  int observed = 25;                      // frames that it is given
  int predicted = 25;                     // frames that it was trained to forecast
  double rate = 25.0;                     // Hz
  std::vector<PushKind> push_kinds = {};  // of the pushes learned from; empty: not known
  ParticleLayout layout;
  KeptJson training{};  // provenance
};

// Settings that may differ from the training. Shares of the blend in `particles` are taken as
// trained.
struct GeneratorChanges {
  bool ridge = true, simlpe = true;  // false: left out of the blend
  ParticleGeneratorOptions particles = {};
  DiffusionGeneratorOptions diffusion = {};
  uint64_t seed = 1;  // of the samples that a forecast by diffusion averages
};

// The networks of a generator, by its kind.
class KindNetworks {
 public:
  virtual ~KindNetworks() = default;
  virtual GeneratorKind kind() const = 0;
  // The kind's own settings, beside those of all kinds.
  virtual nlohmann::ordered_json Settings() const = 0;
  virtual TensorList Tensors() const = 0;
  virtual std::unique_ptr<MotionGenerator> Make(const GeneratorSettings& settings,
                                                const GeneratorChanges& changes) const = 0;
};
using SharedNetworks = std::shared_ptr<const KindNetworks>;

// settings: as Settings() says; of_all: what every kind has. Throws nlohmann's exceptions, and
// Demand's where something does not fit.
using GeneratorReader = SharedNetworks(const nlohmann::ordered_json& settings,
                                       const GeneratorSettings& of_all, TensorFields* reader);
GeneratorReader ReadParticles, ReadDiffusion;

struct GeneratorKindRow {
  const char* name;
  GeneratorKind value;
  const char* what;  // for the list of kinds on the command line
  // Recordings of groups whose people see each other, which physics may blend with, shown any
  // number of frames. Otherwise clips of motion capture, one body by itself.
  bool groups;
  int seeds;          // networks that are averaged, if no flag says otherwise
  const char* paper;  // whose settings --published takes
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

// Takes the trainer of every seed, in turn, to its end.
using SeedRunner = std::function<void(Trainer* trainer)>;
// Error: nothing to learn from.
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

// Errors: no such folder, settings or tensors that are missing or do not fit.
Result<TrainedNetworks> ReadGenerator(const std::string& folder);

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

// People who are pushed, as particles: 22 joints whose places count from where the hip
// stands above the floor at frame 0, and the push as what acts on them.
//
// Everybody faces the way of the published pushes, +x, or is to be turned there first: a mirror
// changes y. A push of a frame is [Fx, Fy, Ftheta, Fphi] over the mass, in N/kg and N m/kg.

inline constexpr int kPushControls = 4;

ParticleLayout PushLayout(const std::vector<std::string>& joint_names);

// One person, all frames of the recording; pushes of others are not seen.
ObservedMotion ParticlesOf(const BodyRecording& recording, int person);
// Their body again, where the particles stand.
BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector2f& place);

// The prediction of physics that see as many frames as the generator. Errors: a model that leaves
// its domain.
Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames = 0);

// Everybody of a recording, for generators whose people see each other.
std::vector<ObservedMotion> GroupOf(const BodyRecording& recording);

// The kinds of a scene's pushes, each once.
std::vector<PushKind> PushKindsOf(const Scene& scene);
// Says which pushes are of a kind that the generator has not learned from; empty: none.
std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene);

// A generator's bodies of a recording whose first `observed` frames it is shown: those, then its
// forecast to the recording's end, or for `frames` frames in all. physics: predict the hips that
// the forecast may be blended with; null: none. Errors: a recording that is not at the generator's
// rate, or too short; those of PredictBeside.
Result<std::vector<BodyMotion>> GenerateBodies(const GeneratorSettings& settings,
                                               const MotionGenerator& generator,
                                               const BodyRecording& recording,
                                               const IdentifiedModel* physics = nullptr,
                                               int frames = 0);

}  // namespace pushid
