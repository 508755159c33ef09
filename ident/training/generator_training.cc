// ident: seeds trained one after the other.
#include "ident/training/generator_training.h"

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "ident/training/restoration_training_checkpoint.h"

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

std::string SeedsCheckpoint(const std::string& path, int index) {
  return path.empty() ? "" : path + "." + std::to_string(index + 1);
}

// One seed, from its checkpoint on, to its end. Points go to the curve of all.
template <typename Trainer>
MaybeError RunToEnd(Trainer* trainer, const std::string& key, int steps, int index,
                    const GeneratorTrainingOptions& options, const TrainingProgress& progress,
                    TrainedGenerator* trained) {
  Checkpoint checkpoint(SeedsCheckpoint(options.checkpoint, index), key,
                        options.checkpoint_seconds);
  std::string state;
  std::vector<TrainingPoint> curve;
  if (checkpoint.Load(&state, &curve) && trainer->Resume(state)) {
    trained->resumed = true;
  } else {
    curve.clear();
  }
  while (!trainer->Done()) {
    TrainingPoint point = trainer->RunRound();
    point.stage = "seed " + std::to_string(index + 1) + ", " + point.stage;
    curve.push_back(point);
    if (progress) progress(point, (index + 1.0 * point.epoch / steps) / options.seeds);
    // A seed that is done stays on disk until all are.
    if (!checkpoint.Due() && !(trainer->Done() && !options.checkpoint.empty())) continue;
    if (MaybeError error = checkpoint.Save(trainer->State(), curve)) return *error;
  }
  trained->curve.insert(trained->curve.end(), curve.begin(), curve.end());
  return std::nullopt;
}

MaybeError TrainParticles(const GeneratorSamples& samples, const GeneratorTrainingOptions& options,
                          const TrainingProgress& progress, TrainedGenerator* trained) {
  const int window = options.particles.from_start
                         ? options.particles.observed + 1
                         : options.particles.observed + options.particles.predicted;
  bool enough = false;
  for (const LearntParticles& motion : samples.learnt) enough |= motion.motion.cols() >= window;
  if (!enough) {
    return Error{"there is nothing to train on: no motion has " + std::to_string(window) +
                 " frames"};
  }
  TrainedParticles particles;
  particles.jitter = options.particles.jitter;
  for (int index = 0; index < options.seeds; ++index) {
    ParticleTrainingOptions of_seed = options.particles;
    of_seed.seed += static_cast<uint64_t>(index);
    ParticleTrainer trainer(samples.settings.layout, samples.learnt, samples.held, of_seed);
    if (MaybeError error =
            RunToEnd(&trainer, KeyOf(samples, of_seed), of_seed.steps + of_seed.noise_steps, index,
                     options, progress, trained)) {
      return error;
    }
    particles.members.push_back(trainer.Network());
  }
  if (options.ridge_share > 0.0) {
    RidgeFit fit;
    for (const Trajectories& motion : samples.ridge) {
      fit.Add(motion, samples.settings.observed, samples.settings.predicted);
    }
    particles.ridge = fit.Solve(options.ridge_penalty);
    particles.ridge_share = options.ridge_share;
  }
  trained->networks.of_kind = std::move(particles);
  return std::nullopt;
}

MaybeError TrainDiffusion(const GeneratorSamples& samples, const GeneratorTrainingOptions& options,
                          const TrainingProgress& progress, TrainedGenerator* trained) {
  if (samples.groups.empty()) {
    return Error{"there is nothing to train on: diffusion is trained on recordings of pushes"};
  }
  TrainedDiffusion diffusion;
  for (int index = 0; index < options.seeds; ++index) {
    DiffusionTrainingOptions of_seed = options.diffusion;
    of_seed.seed += static_cast<uint64_t>(index);
    DiffusionTrainer trainer(samples.groups, samples.held_groups, of_seed);
    if (MaybeError error = RunToEnd(&trainer, KeyOf(samples, of_seed), of_seed.steps, index,
                                    options, progress, trained)) {
      return error;
    }
    diffusion.members.push_back(trainer.Network());
  }
  trained->networks.of_kind = std::move(diffusion);
  return std::nullopt;
}

}  // namespace

Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress) {
  TrainedGenerator trained;
  trained.networks.settings = samples.settings;
  const auto train = options.kind == GeneratorKind::kDiffusion ? TrainDiffusion : TrainParticles;
  if (MaybeError error = train(samples, options, progress, &trained)) return *error;
  for (int index = 0; index < options.seeds; ++index) {
    Checkpoint(SeedsCheckpoint(options.checkpoint, index), "", 0.0).Remove();
  }
  return trained;
}

}  // namespace pushid
