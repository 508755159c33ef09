// ident: seeds trained one after the other.
#include "ident/training/generator_training.h"

#include "datasets/files/content_hash.h"
#include "datasets/files/number_text.h"
#include "ident/training/restoration_training_checkpoint.h"

namespace pushid {
namespace {

std::string KeyOf(const GeneratorSamples& samples, const ParticleTrainingOptions& o) {
  ContentHash hash;
  const auto add = [&hash](const Eigen::MatrixXf& values) {
    hash.Add({reinterpret_cast<const char*>(values.data()),
              static_cast<size_t>(values.size()) * sizeof(float)});
  };
  for (const auto* motions : {&samples.learnt, &samples.held}) {
    for (const LearntParticles& motion : *motions) {
      hash.Add(std::to_string(motion.group) + " " + std::to_string(motion.motion.cols()));
      add(motion.motion);
      add(motion.controls);
    }
  }
  std::string key = "generator 1 " + NameOf(o.structure.cell) + " " + NameOf(o.noise_loss);
  for (double value : {double(o.structure.skip),
                       double(o.structure.pose_operator),
                       double(o.structure.particles),
                       double(o.structure.controls),
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
                       double(o.seed)}) {
    key += " " + DoubleText(value);
  }
  return key + " " + hash.Hex();
}

std::string SeedsCheckpoint(const std::string& path, int index) {
  return path.empty() ? "" : path + "." + std::to_string(index + 1);
}

// One seed, from its checkpoint on. Points go to the curve of all.
Result<ParticleNetwork> TrainSeed(const GeneratorSamples& samples,
                                  const GeneratorTrainingOptions& options, int index,
                                  const TrainingProgress& progress, TrainedGenerator* trained) {
  ParticleTrainingOptions particles = options.particles;
  particles.seed += static_cast<uint64_t>(index);
  ParticleTrainer trainer(samples.settings.layout, samples.learnt, samples.held, particles);
  Checkpoint checkpoint(SeedsCheckpoint(options.checkpoint, index), KeyOf(samples, particles),
                        options.checkpoint_seconds);
  std::string state;
  std::vector<TrainingPoint> curve;
  if (checkpoint.Load(&state, &curve) && trainer.Resume(state)) {
    trained->resumed = true;
  } else {
    curve.clear();
  }
  const int all = particles.steps + particles.noise_steps;
  while (!trainer.Done()) {
    TrainingPoint point = trainer.RunRound();
    point.stage = "seed " + std::to_string(index + 1) + ", " + point.stage;
    curve.push_back(point);
    if (progress) progress(point, (index + 1.0 * point.epoch / all) / options.seeds);
    // A seed that is done stays on disk until all are.
    if (!checkpoint.Due() && !(trainer.Done() && !options.checkpoint.empty())) continue;
    if (MaybeError error = checkpoint.Save(trainer.State(), curve)) return *error;
  }
  trained->curve.insert(trained->curve.end(), curve.begin(), curve.end());
  return trainer.Network();
}

}  // namespace

Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress) {
  const int window = options.particles.from_start
                         ? options.particles.observed + 1
                         : options.particles.observed + options.particles.predicted;
  bool enough = false;
  for (const LearntParticles& motion : samples.learnt) enough |= motion.motion.cols() >= window;
  if (!enough) {
    return Error{"there is nothing to learn from: no motion has " + std::to_string(window) +
                 " frames"};
  }
  TrainedGenerator trained;
  trained.particles.settings = samples.settings;
  trained.particles.jitter = options.particles.jitter;
  for (int index = 0; index < options.seeds; ++index) {
    Result<ParticleNetwork> network = TrainSeed(samples, options, index, progress, &trained);
    if (!network.ok()) return network.error();
    trained.particles.members.push_back(std::move(network.value()));
  }
  if (options.ridge_share > 0.0) {
    RidgeFit fit;
    for (const Trajectories& motion : samples.ridge) {
      fit.Add(motion, samples.settings.observed, samples.settings.predicted);
    }
    trained.particles.ridge = fit.Solve(options.ridge_penalty);
    trained.particles.ridge_share = options.ridge_share;
  }
  for (int index = 0; index < options.seeds; ++index) {
    Checkpoint(SeedsCheckpoint(options.checkpoint, index), "", 0.0).Remove();
  }
  return trained;
}

}  // namespace pushid
