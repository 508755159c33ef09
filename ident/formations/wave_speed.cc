// ident: the speed of a wave from its onsets.
#include "ident/formations/wave_speed.h"

namespace pushid {

std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets) {
  if (scene.pushes.size() != 1) return std::nullopt;
  int first = -1, foremost = -1;
  for (int n = 0; n < scene.num_people(); ++n) {
    if (onsets[n] < 0) continue;
    if (first < 0 || onsets[n] < onsets[first]) first = n;
    foremost = n;
  }
  if (first < 0) return std::nullopt;
  const WaveSpeed wave{first, foremost,
                       scene.people[foremost].start.q[0] - scene.people[first].start.q[0],
                       (onsets[foremost] - onsets[first]) * scene.dt};
  if (!(wave.metres > 0.0) || !(wave.seconds > 0.0)) return std::nullopt;
  return wave;
}

std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run) {
  std::vector<int> onsets;
  for (const PersonSummary& person : run.summaries) onsets.push_back(person.onset_frame);
  return SpeedOfWave(run.recording.scene, onsets);
}

}  // namespace pushid
