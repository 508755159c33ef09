// ident: trainings of generators: seeds one after the other, and the kinds' own.
#include "ident/training/generator_training.h"

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "ident/generators/trained_networks.h"

namespace pushid {
namespace {

void AddTo(ContentHash* hash, const Eigen::MatrixXf& values) {
  hash->Add({reinterpret_cast<const char*>(values.data()),
             static_cast<size_t>(values.size()) * sizeof(float)});
}

std::string Joined(const std::string& begin, const std::vector<double>& values,
                   const ContentHash& hash) {
  std::string key = begin;
  for (double value : values) key += " " + DoubleText(value);
  return key + " " + hash.Hex();
}

std::string KeyOf(const GeneratorSamples& samples, const ParticleTrainingOptions& o) {
  ContentHash hash;
  for (const auto* motions : {&samples.learnt, &samples.held}) {
    for (const LearntParticles& motion : *motions) {
      hash.Add(std::to_string(motion.group) + " " + std::to_string(motion.motion.cols()));
      AddTo(&hash, motion.motion);
      AddTo(&hash, motion.controls);
    }
  }
  return Joined("generator 2 " + NameOf(o.structure.cell) + " " + NameOf(o.noise_loss),
                {double(o.structure.skip),
                 double(o.structure.pose_operator),
                 double(o.structure.particles),
                 double(o.structure.controls),
                 double(o.structure.corrected_frames),
                 double(o.observed),
                 double(o.predicted),
                 double(o.from_start),
                 double(o.even_frames),
                 double(o.steps),
                 double(o.noise_steps),
                 double(o.batch),
                 double(o.warm_up),
                 o.learning_rate,
                 o.clip,
                 o.jitter,
                 o.mirrored,
                 o.squared,
                 o.bones,
                 o.critic,
                 double(o.seed)},
                hash);
}

std::string KeyOf(const GeneratorSamples& samples, const DiffusionTrainingOptions& o) {
  ContentHash hash;
  for (const auto* groups : {&samples.groups, &samples.held_groups}) {
    for (const ObservedGroup& group : *groups) {
      hash.Add(std::to_string(group.size()));
      for (const ObservedMotion& person : group) {
        AddTo(&hash, person.frames);
        AddTo(&hash, person.controls);
        AddTo(&hash, person.pendulum);
        AddTo(&hash, Eigen::Vector3f(person.place.x(), person.place.y(), person.mass));
      }
    }
  }
  return Joined("diffusion 1 " + NameOf(o.structure.pooling),
                {double(o.structure.pendulum), double(o.steps), double(o.groups),
                 double(o.people_alone), double(o.warm_up), o.learning_rate, o.weight_decay, o.clip,
                 o.averaging, o.dropout, o.bystanders, o.turn, o.size, o.dt, double(o.seed)},
                hash);
}

// The options of a seed.
template <typename Options>
Options OfSeed(Options options, int index, const TrainerOptions& of_all) {
  options.seed = of_all.seed + static_cast<uint64_t>(index);
  options.num_threads = of_all.num_threads;
  return options;
}

std::string SeedsCheckpoint(const std::string& path, int index) {
  return path.empty() ? "" : path + "." + std::to_string(index + 1);
}

}  // namespace

Result<SharedNetworks> TrainParticles(const GeneratorSamples& samples,
                                      const GeneratorTrainingOptions& options,
                                      const SeedRunner& run) {
  const int window = options.particles.from_start
                         ? options.particles.observed + 1
                         : options.particles.observed + options.particles.predicted;
  bool enough = false;
  for (const LearntParticles& motion : samples.learnt) enough |= motion.motion.cols() >= window;
  if (!enough) {
    return Error{"there is nothing to train on: no motion has " + std::to_string(window) +
                 " frames"};
  }
  const auto particles = std::make_shared<TrainedParticles>();
  particles->jitter = options.particles.jitter;
  for (int index = 0; index < options.seeds; ++index) {
    const ParticleTrainingOptions of_seed = OfSeed(options.particles, index, options);
    ParticleTrainer trainer(samples.settings.layout, samples.learnt, samples.held, of_seed);
    if (MaybeError error = run(&trainer, KeyOf(samples, of_seed))) return *error;
    particles->members.push_back(trainer.Network());
  }
  if (options.ridge_share > 0.0) {
    RidgeFit fit;
    for (const Trajectories& motion : samples.ridge) {
      fit.Add(motion, samples.settings.observed, samples.settings.predicted);
    }
    particles->ridge = fit.Solve(options.ridge_penalty);
    particles->ridge_share = options.ridge_share;
  }
  return SharedNetworks(particles);
}

Result<SharedNetworks> TrainDiffusion(const GeneratorSamples& samples,
                                      const GeneratorTrainingOptions& options,
                                      const SeedRunner& run) {
  if (samples.groups.empty()) {
    return Error{"there is nothing to train on: diffusion is trained on recordings of pushes"};
  }
  const auto diffusion = std::make_shared<TrainedDiffusion>();
  for (int index = 0; index < options.seeds; ++index) {
    const DiffusionTrainingOptions of_seed = OfSeed(options.diffusion, index, options);
    DiffusionTrainer trainer(samples.groups, samples.held_groups, of_seed);
    if (MaybeError error = run(&trainer, KeyOf(samples, of_seed))) return *error;
    diffusion->members.push_back(trainer.Network());
  }
  return SharedNetworks(diffusion);
}

Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress) {
  TrainedGenerator trained;
  int index = 0;
  const SeedRunner run = [&](Trainer* trainer, const std::string& key) {
    const auto told = [&](TrainingPoint* point) {
      point->stage = "seed " + std::to_string(index + 1) + ", " + point->stage;
      if (progress) progress(*point, (index + trainer->ShareDone()) / options.seeds);
    };
    const CheckpointOptions checkpoint = {SeedsCheckpoint(options.checkpoint, index),
                                          options.checkpoint_seconds};
    const MaybeError error = RunToEnd(trainer, key, checkpoint, told, &trained);
    ++index;
    return error;
  };
  GeneratorTrainer* train = kGeneratorTrainers[static_cast<size_t>(options.kind)];
  Result<SharedNetworks> networks = train(samples, options, run);
  if (!networks.ok()) return networks.error();
  trained.networks = {samples.settings, std::move(networks.value())};
  for (int i = 0; i < index; ++i) RemoveCheckpoint(SeedsCheckpoint(options.checkpoint, i));
  return trained;
}

}  // namespace pushid
