// ident: trainings of generators: seeds one after the other, and the kinds' own.
#include "ident/training/generator_training.h"

#include <algorithm>
#include <map>
#include <set>

#include "datasets/files/input_file.h"
#include "datasets/loading/generator_data.h"
#include "ident/generators/generator_files.h"
#include "ident/generators/push_particles.h"
#include "ident/training/restoration_training.h"

namespace pushid {
namespace {

constexpr double kRidgePenalty = 1e-2;  // m^2

void AddTo(ContentHash* hash, const Eigen::MatrixXf& values) {
  hash->Add({reinterpret_cast<const char*>(values.data()),
             static_cast<size_t>(values.size()) * sizeof(float)});
}

// The key of one seed's training: its data and its options.
std::string KeyOf(const GeneratorSamples& samples, const GeneratorTrainingOptions& options,
                  const std::string& network, const TrainerOptions& of_seed) {
  ContentHash hash;
  hash.Add(options.configuration);
  for (const auto* motions : {&samples.learnt, &samples.held}) {
    for (const LearntParticles& motion : *motions) {
      hash.Add(std::to_string(motion.group) + " " + std::to_string(motion.motion.cols()));
      AddTo(&hash, motion.motion);
    }
  }
  for (const auto* groups : {&samples.groups, &samples.held_groups}) {
    for (const ObservedGroup& group : *groups) {
      hash.Add(std::to_string(group.size()));
      for (const ObservedMotion& person : group) {
        AddTo(&hash, person.frames);
        AddTo(&hash, person.controls);
        AddTo(&hash, Eigen::Vector3f(person.place.x(), person.place.y(), person.mass));
      }
    }
  }
  return network + " " + std::to_string(of_seed.seed) + " " + hash.Hex();
}

std::string SeedsCheckpoint(const std::string& path, int index) {
  return path.empty() ? "" : path + "." + std::to_string(index + 1);
}

// Networks of so many seeds; data: what their trainer learns from.
template <typename OfKind, typename Options, typename Network, typename... Data>
MaybeError TrainSeeds(const char* name, const Options& of_kind, int seeds,
                      const GeneratorSamples& samples, const GeneratorTrainingOptions& options,
                      const SeedRunner& run, std::vector<Network>* members, const Data&... data) {
  for (int index = 0; index < seeds; ++index) {
    Options of_seed = of_kind;
    of_seed.seed = options.seed + static_cast<uint64_t>(index);
    of_seed.num_threads = options.num_threads;
    OfKind trainer(data..., of_seed);
    if (MaybeError error = run(&trainer, KeyOf(samples, options, name, of_seed))) return error;
    members->push_back(trainer.Network());
  }
  return std::nullopt;
}

}  // namespace

Result<SharedNetworks> TrainParticles(const GeneratorSamples& samples,
                                      const GeneratorTrainingOptions& options,
                                      const SeedRunner& run) {
  const int window = options.particles.observed + options.particles.predicted;
  bool enough = false;
  for (const LearntParticles& motion : samples.learnt) enough |= motion.motion.cols() >= window;
  if (!enough) {
    return Error{"there is nothing to train on: no motion has " + std::to_string(window) +
                 " frames"};
  }
  const auto particles = std::make_shared<TrainedParticles>();
  particles->jitter = options.particles.jitter;
  particles->simlpe_share = options.simlpe_share;
  MaybeError error = TrainSeeds<ParticleTrainer>(
      "particles", options.particles, options.seeds, samples, options, run, &particles->members,
      samples.settings.layout, samples.learnt, samples.held);
  if (!error && options.simlpe_share > 0.0) {
    error = TrainSeeds<SimlpeTrainer>("simlpe", options.simlpe, 1, samples, options, run,
                                      &particles->partners.simlpe, samples.settings.layout,
                                      samples.learnt, samples.held);
  }
  if (error) return *error;
  if (options.ridge_share > 0.0) {
    RidgeFit fit;
    for (const Trajectories& motion : samples.ridge) {
      fit.Add(motion, samples.settings.observed, samples.settings.predicted);
    }
    particles->partners.ridge = fit.Solve(kRidgePenalty);
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
  if (MaybeError error = TrainSeeds<DiffusionTrainer>("diffusion", options.diffusion, options.seeds,
                                                      samples, options, run, &diffusion->members,
                                                      samples.groups, samples.held_groups)) {
    return *error;
  }
  return SharedNetworks(diffusion);
}

Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress) {
  TrainedGenerator trained;
  const bool has_partner = options.kind == GeneratorKind::kParticles && options.simlpe_share > 0.0;
  const int networks_in_all = options.seeds + (has_partner ? 1 : 0);
  int index = 0;
  const SeedRunner run = [&](Trainer* trainer, const std::string& key) {
    const auto told = [&](TrainingPoint* point) {
      point->stage = "network " + std::to_string(index + 1) + ", " + point->stage;
      if (progress) progress(*point, (index + trainer->ShareDone()) / networks_in_all);
    };
    const CheckpointOptions checkpoint = {SeedsCheckpoint(options.checkpoint, index),
                                          index + 1 < networks_in_all};
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

namespace {

std::vector<ObservedGroup> ObservedGroups(const std::vector<BodyRecording>& recordings,
                                          const std::vector<int>& among) {
  std::vector<ObservedGroup> groups;
  for (int i : among) groups.push_back(GroupOf(recordings[i]));
  return groups;
}

}  // namespace

GeneratorSamples SamplesOf(const MocapFolder& mocap, bool with_validation, int phases) {
  GeneratorSamples samples;
  samples.settings.observed = kObservedFrames;
  samples.settings.predicted = kForecastFrames;
  samples.settings.rate = kForecastRate;
  samples.settings.layout = mocap.skeleton.layout;
  std::map<std::string, int> actions;
  for (LearntMotion& motion : LearntMotions(mocap, with_validation, phases)) {
    const int action =
        actions.emplace(motion.action, static_cast<int>(actions.size())).first->second;
    if (motion.phase == 0) samples.ridge.push_back(motion.motion);
    samples.learnt.push_back({action, std::move(motion.motion)});
  }
  for (const MocapClip& clip : mocap.clips) {
    if (!IsValidationClip(mocap, clip)) continue;
    samples.held.push_back({0, EverySecond(clip.motion, 0)});
  }
  return samples;
}

GeneratorSamples SamplesOf(const std::vector<BodyRecording>& recordings,
                           const std::vector<int>& among, const std::vector<int>& held,
                           int observed) {
  GeneratorSamples samples;
  GeneratorSettings& settings = samples.settings;
  settings.observed = observed;
  settings.rate = 1.0 / recordings.front().pendulum.scene.dt;
  settings.layout = PushLayout(recordings.front().joint_names);
  std::set<PushKind> kinds;
  for (int i : among) {
    for (const PushKind kind : PushKindsOf(recordings[i].pendulum.scene)) kinds.insert(kind);
  }
  settings.push_kinds.assign(kinds.begin(), kinds.end());
  samples.groups = ObservedGroups(recordings, among);
  samples.held_groups = ObservedGroups(recordings, held);
  int longest = observed + 1;
  for (const ObservedGroup& group : samples.groups) {
    longest = std::max(longest, static_cast<int>(group.front().frames.cols()));
  }
  settings.predicted = longest - observed;
  return samples;
}

void SetForData(const GeneratorSamples& samples, GeneratorTrainingOptions* options) {
  const GeneratorSettings& settings = samples.settings;
  options->diffusion.dt = 1.0 / settings.rate;
  ParticleTrainingOptions& particles = options->particles;
  particles.observed = settings.observed;
  particles.predicted = settings.predicted;
  // siMLPe forecasts as many frames as it sees, and more from its own.
  options->simlpe.observed = options->simlpe.predicted = settings.observed;
  if (options->correction) particles.structure.corrected_frames = settings.predicted;
}

}  // namespace pushid
