// ident: training of generators: several seeds, one after the other, and the linear forecast beside
// them, with checkpoints. Needs LibTorch (behind models/).
#pragma once

#include <vector>

#include "datasets/loading/generator_data.h"
#include "ident/generators/push_particles.h"
#include "ident/training/training_run.h"

namespace pushid {

// TrainerOptions::seed is the first network's.
struct GeneratorTrainingOptions : TrainerOptions, CheckpointOptions, KindTrainingOptions {
  GeneratorKind kind = GeneratorKind::kParticles;
  std::string configuration;  // what a checkpoint must have been made with, beside the data
  int seeds = RowOf(GeneratorKind::kParticles).seeds;  // networks that are averaged
  // For particles: a correction of the whole forecast (models/generators/particle_generator.h), and
  // shares of the blend that they are part of.
  bool correction = true;
  double ridge_share = ParticleGeneratorOptions{}.ridge_share;
  double simlpe_share = ParticleGeneratorOptions{}.simlpe_share;
};

struct GeneratorSamples {
  GeneratorSettings settings;
  std::vector<LearntParticles> learnt, held;       // of particles
  std::vector<Trajectories> ridge;                 // what the linear forecast learns from
  std::vector<ObservedGroup> groups, held_groups;  // of diffusion
};

// All clips but those below test/; with_validation: also the validation clips, which otherwise only
// show how the training goes. phases: as in LearntMotions.
GeneratorSamples SamplesOf(const MocapFolder& mocap, bool with_validation, int phases = 2);

// The groups of the recordings `among`, whole; those of `held` show how the training goes.
GeneratorSamples SamplesOf(const std::vector<BodyRecording>& recordings,
                           const std::vector<int>& among, const std::vector<int>& held,
                           int observed);

// Options that the data decide: frames of a window, the rate.
void SetForData(const GeneratorSamples& samples, GeneratorTrainingOptions* options);

// Stages of the curve are "network 1, drift", ...
struct TrainedGenerator : TrainingCourse {
  TrainedNetworks networks;
};

// Errors: nothing to learn from, a checkpoint that cannot be written. A checkpoint of other data or
// options is not used.
Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress = nullptr);

}  // namespace pushid
