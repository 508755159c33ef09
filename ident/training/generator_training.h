// ident: training of generators: several seeds, one after the other, and the linear forecast beside
// them, with checkpoints. Needs LibTorch (behind models/).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/loading/mocap_folder.h"
#include "ident/generators/push_particles.h"
#include "ident/training/restoration_training.h"
#include "models/generators/diffusion_trainer.h"
#include "models/generators/particle_trainer.h"

namespace pushid {

struct GeneratorTrainingOptions {
  GeneratorKind kind = GeneratorKind::kParticles;
  ParticleTrainingOptions particles;  // of every seed; seed is the first one's
  DiffusionTrainingOptions diffusion;
  int seeds = 3;  // networks that are averaged
  bool correction =
      true;  // cmu: of the whole forecast at once (models/generators/particle_network.h)
  double ridge_share = ParticleGeneratorOptions{}.ridge_share;
  double ridge_penalty = 1e-2;  // m^2
  std::string checkpoint;       // file, one per seed beside it; empty: none
  double checkpoint_seconds = 20.0;
};

struct GeneratorSamples {
  GeneratorSettings settings;
  std::vector<LearntParticles> learnt, held;
  std::vector<ObservedGroup> groups, held_groups;  // of diffusion
  std::vector<Trajectories> ridge;                 // what the linear forecast learns from
};

// Both phases of all clips but those below test/; with_validation: also the validation clips, which
// otherwise only show how the training goes.
GeneratorSamples SamplesOf(const MocapFolder& mocap, bool with_validation);

// Where physics have everybody who were fitted to other recordings of `among`, by recording;
// nothing of recordings that are not among them, or whose rollout failed.
std::vector<GroupHips> OutOfFoldHips(const std::vector<BodyRecording>& recordings,
                                     const std::vector<int>& among, const FitOptions& physics,
                                     uint64_t seed);

// Every person of the recordings `among`, whole; those of `held` show how the training goes.
// pendulums: OutOfFoldHips, of which diffusion leaves out recordings without any; or empty.
GeneratorSamples SamplesOf(const std::vector<BodyRecording>& recordings,
                           const std::vector<int>& among, const std::vector<int>& held,
                           int observed, const std::vector<GroupHips>& pendulums = {});

// Options that the data decide: frames of a window, where it starts, controls, the rate.
void SetForData(const GeneratorSamples& samples, GeneratorTrainingOptions* options);

struct TrainedGenerator {
  TrainedNetworks networks;
  std::vector<TrainingPoint> curve;  // stages "seed 1, drift", ...
  bool resumed = false;
};

// Errors: nothing to learn from, a checkpoint that cannot be written. A checkpoint of other data or
// options is not used.
Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress = nullptr);

}  // namespace pushid
