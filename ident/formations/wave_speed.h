// ident: how fast a push goes through a formation.
#pragma once

#include <optional>
#include <vector>

#include "ident/formations/formation_run.h"

namespace pushid {

// From the first person who moves to the foremost one who does; people are numbered forwards.
struct WaveSpeed {
  int from = 0, to = 0;  // persons
  double metres = 0.0, seconds = 0.0;
  double MetresPerSecond() const { return metres / seconds; }
};

// onsets: a frame for each person, -1 for who never moves. Nothing where several pushes make
// several waves, and where fewer than two move or both at once.
std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets);
std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run);

}  // namespace pushid
