// ident: what generators learn from.
#include <algorithm>
#include <map>
#include <set>

#include "datasets/loading/forecast_windows.h"
#include "ident/generators/push_particles.h"
#include "ident/training/generator_training.h"
#include "ident/training/restoration_data.h"

namespace pushid {
namespace {

// Motions of the recordings, a group a person's share of the push: everybody counts alike.
std::vector<LearntParticles> People(const std::vector<BodyRecording>& recordings,
                                    const std::vector<int>& among) {
  std::vector<LearntParticles> people;
  for (int i : among) {
    for (int n = 0; n < recordings[i].num_people(); ++n) {
      PushedParticles particles = ParticlesOf(recordings[i], n);
      people.push_back(
          {0, std::move(particles.motion.frames), std::move(particles.motion.controls)});
    }
  }
  return people;
}

std::vector<ObservedGroup> ObservedGroups(const std::vector<BodyRecording>& recordings,
                                          const std::vector<int>& among,
                                          const std::vector<GroupHips>& pendulums) {
  std::vector<ObservedGroup> groups;
  for (int i : among) {
    if (!pendulums.empty() && pendulums[i].empty()) continue;
    groups.push_back(GroupOf(recordings[i], pendulums.empty() ? GroupHips() : pendulums[i]));
  }
  return groups;
}

std::vector<PushKind> PushKindsAmong(const std::vector<BodyRecording>& recordings,
                                     const std::vector<int>& among) {
  std::set<PushKind> kinds;
  for (int i : among) {
    for (const PushKind kind : PushKindsOf(recordings[i].pendulum.scene)) kinds.insert(kind);
  }
  return {kinds.begin(), kinds.end()};
}

}  // namespace

GeneratorSamples SamplesOf(const MocapFolder& mocap, bool with_validation) {
  GeneratorSamples samples;
  samples.settings.data = GeneratorData::kCmu;
  samples.settings.observed = kObservedFrames;
  samples.settings.predicted = kForecastFrames;
  samples.settings.rate = kForecastRate;
  samples.settings.layout = mocap.skeleton.layout;
  std::map<std::string, int> actions;
  for (LearntMotion& motion : LearntMotions(mocap, with_validation)) {
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

std::vector<GroupHips> OutOfFoldHips(const std::vector<BodyRecording>& recordings,
                                     const std::vector<int>& among, const FitOptions& physics,
                                     uint64_t seed) {
  constexpr int kInnerFolds = 4;
  std::vector<GroupHips> hips(recordings.size());
  const auto paths = PredictOutOfFold(PendulumsOf(recordings), among, physics, kInnerFolds, seed);
  for (size_t k = 0; k < among.size(); ++k) {
    if (paths[k].num_frames() == 0) continue;
    hips[among[k]] = PendulumHips(recordings[among[k]], paths[k]);
  }
  return hips;
}

GeneratorSamples SamplesOf(const std::vector<BodyRecording>& recordings,
                           const std::vector<int>& among, const std::vector<int>& held,
                           int observed, const std::vector<GroupHips>& pendulums) {
  GeneratorSamples samples;
  GeneratorSettings& settings = samples.settings;
  settings.data = GeneratorData::kPushes;
  settings.observed = observed;
  settings.rate = 1.0 / recordings.front().pendulum.scene.dt;
  settings.layout = PushLayout(recordings.front().joint_names);
  settings.pendulum = !pendulums.empty();
  settings.push_kinds = PushKindsAmong(recordings, among);
  samples.learnt = People(recordings, among);
  samples.held = People(recordings, held);
  samples.groups = ObservedGroups(recordings, among, pendulums);
  samples.held_groups = ObservedGroups(recordings, held, pendulums);
  int longest = observed + 1;
  for (const auto& motion : samples.learnt) {
    longest = std::max(longest, static_cast<int>(motion.motion.cols()));
  }
  settings.predicted = longest - observed;
  return samples;
}

void SetForData(const GeneratorSamples& samples, GeneratorTrainingOptions* options) {
  const GeneratorSettings& settings = samples.settings;
  options->diffusion.dt = 1.0 / settings.rate;
  options->diffusion.structure.pendulum = settings.pendulum;
  ParticleTrainingOptions& particles = options->particles;
  particles.observed = settings.observed;
  particles.predicted = settings.predicted;
  if (settings.data != GeneratorData::kPushes) {
    if (options->correction) particles.structure.corrected_frames = settings.predicted;
    return;
  }
  // A push stands at the start of its recording, recordings differ in length, and a metric is a
  // mean over all frames.
  particles.from_start = true;
  particles.even_frames = true;
  particles.structure.controls = kPushControls;
  particles.mirrored_controls = kMirroredPush;
  options->ridge_share = 0.0;  // it knows one horizon only
}

}  // namespace pushid
