// ident: training of generators: several seeds, one after the other, and the linear forecast beside
// them. Needs LibTorch (behind models/).
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

// TrainerOptions::seed is the first network's.
struct GeneratorTrainingOptions : TrainerOptions {
  GeneratorKind kind = GeneratorKind::kParticles;
  // Options of every seed's training, by kind; siMLPe stands beside particles.
  ParticleTrainingOptions particles;
  DiffusionTrainingOptions diffusion;
  SimlpeTrainingOptions simlpe;
  int seeds = RowOf(GeneratorKind::kParticles).seeds;  // networks that are averaged
  // Options of particles: a correction of the whole forecast
  // (models/generators/particle_generator.h), and shares of the blend that they are part of.
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
struct TrainedGenerator {
  TrainedNetworks networks;
  std::vector<TrainingPoint> curve;
};

// Error: nothing to learn from.
Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress = nullptr);

// Generators of groups: trained anew for every fold, so that nothing has seen the recordings
// it is judged on.
//
//   generator                  the forecast, of the frames that were not shown
//   generator_all_frames       the recording as far as it is shown, then the forecast
//   generator_unblended        without the physics that the forecast is blended with
//   rigid                      those physics alone, first poses carried by the rods' tips
//   generator_shown_20         shown 20 frames, no physics
//   static, constant_velocity  as in body_evaluation.h, shown as many frames as the generator
//
// All but generator_all_frames and generator_shown_20 count the frames that the generator was not
// shown; generator_shown_20 counts those after its 20.

struct GeneratorValidationOptions : FoldChoice {
  int observed = 20;  // frames that the generator is shown; 1: the first pose, and the push
  std::optional<FitOptions> physics;  // of the pendulum, fitted in every fold too
  GeneratorChanges changes;           // as in its use
};

// Errors: those of CrossValidateBodies; recordings that are too short, a fold whose pendulum finds
// no optimum.
Result<BodyValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                              const GeneratorTrainingOptions& options,
                                              const GeneratorValidationOptions& validation,
                                              const RunProgress& progress = nullptr);

}  // namespace pushid
