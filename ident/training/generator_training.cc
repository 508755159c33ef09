// ident: trainings of generators, and their cross-validation.
#include "ident/training/generator_training.h"

#include <algorithm>
#include <map>
#include <set>

#include "datasets/loading/generator_data.h"
#include "ident/generators/generator_files.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

constexpr double kRidgePenalty = 1e-2;  // m^2

// Trains networks of `seeds` seeds; data: the first arguments of OfKind::Make.
template <typename OfKind, typename Options, typename Network, typename... Data>
void TrainSeeds(const Options& of_kind, int seeds, const GeneratorTrainingOptions& options,
                const SeedRunner& run, std::vector<Network>* members, const Data&... data) {
  for (int index = 0; index < seeds; ++index) {
    Options of_seed = of_kind;
    of_seed.seed = options.seed + static_cast<uint64_t>(index);
    of_seed.num_threads = options.num_threads;
    const auto trainer = OfKind::Make(data..., of_seed);
    run(trainer.get());
    members->push_back(trainer->Network());
  }
}

std::vector<ObservedGroup> ObservedGroups(const std::vector<BodyRecording>& recordings,
                                          const std::vector<int>& among) {
  std::vector<ObservedGroup> groups;
  for (int i : among) groups.push_back(GroupOf(recordings[i]));
  return groups;
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
  TrainSeeds<ParticleTrainer>(options.particles, options.seeds, options, run, &particles->members,
                              samples.settings.layout, samples.learnt, samples.held);
  if (options.simlpe_share > 0.0) {
    TrainSeeds<SimlpeTrainer>(options.simlpe, 1, options, run, &particles->partners.simlpe,
                              samples.settings.layout, samples.learnt, samples.held);
  }
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
  TrainSeeds<DiffusionTrainer>(options.diffusion, options.seeds, options, run, &diffusion->members,
                               samples.groups, samples.held_groups);
  return SharedNetworks(diffusion);
}

Result<TrainedGenerator> TrainGenerator(const GeneratorSamples& samples,
                                        const GeneratorTrainingOptions& options,
                                        const TrainingProgress& progress) {
  TrainedGenerator trained;
  const bool has_partner = options.kind == GeneratorKind::kParticles && options.simlpe_share > 0.0;
  const int networks_in_all = options.seeds + (has_partner ? 1 : 0);
  int index = 0;
  const SeedRunner run = [&](Trainer* trainer) {
    const auto curve = RunToEnd(trainer, [&](TrainingPoint* point) {
      point->stage = "network " + std::to_string(index + 1) + ", " + point->stage;
      if (progress) progress(*point, (index + trainer->ShareDone()) / networks_in_all);
    });
    trained.curve.insert(trained.curve.end(), curve.begin(), curve.end());
    ++index;
  };
  GeneratorTrainer* train = kGeneratorTrainers[static_cast<size_t>(options.kind)];
  Result<SharedNetworks> networks = train(samples, options, run);
  if (!networks.ok()) return networks.error();
  trained.networks = {samples.settings, std::move(networks.value())};
  return trained;
}

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

namespace {

constexpr int kShown = 20;  // frames, of generator_shown_20

// model: the fold's physics, for blending.
Result<BodyScores> ScoreGenerator(const TrainedNetworks& trained,
                                  const std::optional<IdentifiedModel>& model,
                                  const GeneratorValidationOptions& validation,
                                  const BodyRecording& recording) {
  BodyScores scores;
  const auto forecast = [&](int shown,
                            const GeneratorChanges& changes) -> Result<std::vector<BodyMotion>> {
    GeneratorSettings settings = trained.settings;
    settings.observed = shown;
    const bool blended = changes.diffusion.blend > 0.0 && model;
    if (blended) {
      const Result<Prediction> predicted = PredictBeside(settings, *model, recording);
      if (!predicted.ok()) return predicted.error();
      const auto people = PredictedPeople(recording, predicted.value());
      scores["rigid"] = {ScoreBodies(recording, RigidRestoration().Restore(people), shown)};
    }
    return GenerateBodies(settings, *trained.Make(changes), recording, blended ? &*model : nullptr);
  };
  const int observed = validation.observed;
  GeneratorChanges changes = validation.changes;
  changes.diffusion.sampled = std::make_shared<std::vector<Trajectories>>();
  const auto bodies = forecast(observed, changes);
  if (!bodies.ok()) return bodies.error();
  ScoreForecast(recording, bodies.value(), observed, &scores);
  if (changes.diffusion.blend > 0.0) {
    changes.diffusion.blend = 0.0;
    const auto unblended = forecast(observed, changes);
    if (!unblended.ok()) return unblended.error();
    scores["generator_unblended"] = {ScoreBodies(recording, unblended.value(), observed)};
  }
  if (observed == kShown || recording.num_frames() <= kShown) return scores;
  changes.diffusion.sampled.reset();
  const auto shown = forecast(kShown, changes);
  if (!shown.ok()) return shown.error();
  scores["generator_shown_20"] = {ScoreBodies(recording, shown.value(), kShown)};
  return scores;
}

}  // namespace

Result<BodyValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                              const GeneratorTrainingOptions& options,
                                              const GeneratorValidationOptions& validation,
                                              const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const FoldTrainer train = [&](const std::vector<int>& among, const RunProgress& told,
                                double* seconds) -> Result<FoldScorer> {
    std::optional<IdentifiedModel> model;
    if (validation.physics) {
      told("physics", 0.0);
      Result<FittedFolds> fitted = FitFolds(pendulums, among, *validation.physics, 0, options.seed);
      if (!fitted.ok()) return fitted.error();
      model = std::move(fitted.value().model);
    }
    const GeneratorSamples samples = SamplesOf(recordings, among, {}, validation.observed);
    GeneratorTrainingOptions of_fold = options;
    SetForData(samples, &of_fold);
    const double before = Now();
    const Result<TrainedGenerator> trained =
        TrainGenerator(samples, of_fold, [&](const TrainingPoint& point, double done) {
          told(point.stage + ", step " + std::to_string(point.epoch), done);
        });
    if (!trained.ok()) return trained.error();
    *seconds = Now() - before;
    return FoldScorer(
        [&validation, networks = trained.value().networks, model](const BodyRecording& recording) {
          return ScoreGenerator(networks, model, validation, recording);
        });
  };
  return CrossValidateBodies(recordings, validation, train, progress);
}

}  // namespace pushid
