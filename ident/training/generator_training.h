// ident: training of generators: several seeds in turn, and the partners of a blend. Needs LibTorch
// (behind models/).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/generator_data.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/generators/generator_files.h"
#include "ident/problem/folds.h"
#include "ident/training/restoration_training.h"

namespace pushid {

// TrainerOptions::seed: of the first network; it rises by one for each further network.
struct GeneratorTrainingOptions : TrainerOptions {
  GeneratorKind kind = GeneratorKind::kParticles;
  // Options of each seed's training, by kind; siMLPe is trained with particles.
  ParticleTrainingOptions particles;
  DiffusionTrainingOptions diffusion;
  SimlpeTrainingOptions simlpe;
  int seeds = RowOf(GeneratorKind::kParticles).seeds;  // networks that are averaged
  // The correction of whole forecasts by particles, and their blend
  // (models/generators/particle_generator.h).
  bool correction = true;
  double ridge_share = ParticleGeneratorOptions{}.ridge_share;
  double simlpe_share = ParticleGeneratorOptions{}.simlpe_share;
};

struct GeneratorSamples {
  GeneratorSettings settings;
  std::vector<LearntParticles> learnt, held;       // of particles
  std::vector<Trajectories> ridge;                 // of the linear forecast
  std::vector<ObservedGroup> groups, held_groups;  // of diffusion
};

// All clips except those below test/; with_validation: validation clips are trained on instead of
// held out. phases: as in LearntMotions.
GeneratorSamples SamplesOf(const MocapFolder& mocap, bool with_validation, int phases = 2);

// among, held: indices of the recordings to train on, and of those for the held-out loss.
GeneratorSamples SamplesOf(const std::vector<BodyRecording>& recordings,
                           const std::vector<int>& among, const std::vector<int>& held,
                           int observed);

// Sets options that depend on the data: frames of a window, the rate.
void SetForData(const GeneratorSamples& samples, GeneratorTrainingOptions* options);

// Stages of the curve are "network 1, drift", ...
struct TrainedGenerator {
  TrainedNetworks networks;
  std::vector<TrainingPoint> curve;
};

// Errors: no training data.
Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress = nullptr);

// Cross-validation of generators of groups, which are trained again in every fold. Scores:
//
//   generator                  the forecast
//   generator_all_frames       the observed frames, then the forecast
//   generator_unblended        the forecast without physics
//   rigid                      physics alone, the first poses moved with the rods' tips
//   generator_shown_20         the forecast from 20 observed frames, without physics
//   static, constant_velocity  as in body_evaluation.h, from the generator's observed frames
//
// Scores are over the frames after the observed ones, except that generator_all_frames is over all.

struct GeneratorValidationOptions : FoldChoice {
  int observed = 20;                  // frames; 1: the first pose and the push
  std::optional<FitOptions> physics;  // of the pendulum, refitted in every fold
  GeneratorChanges changes;
};

// Errors: those of CrossValidateBodies; recordings that are too short; a fold whose pendulum's fit
// does not converge.
Result<BodyValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                              const GeneratorTrainingOptions& options,
                                              const GeneratorValidationOptions& validation,
                                              const RunProgress& progress = nullptr);

}  // namespace pushid
