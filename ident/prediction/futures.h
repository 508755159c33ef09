// ident: futures drawn from a model: rollouts from the same start and push, driven by its process
// noise; where feet step (models/stance.h), people whose supports are spread as P(step) has it
// (fit/step_probability.h), so that the share of draws in which a person steps is P(step).
//
// Noise of single steps adds up: what a hundred drawn steps scatter by is the model's own word on
// how far people stray. Beside it stand the bands of predictive_bands.h, which take the errors of
// the fitted recordings instead. Both are scored alike (ScoreDraws in evaluation.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ident/prediction/predictive_bands.h"

namespace pushid {

struct Futures {
  std::string id;
  int failed = 0;  // draws that left the domain: in none of the paths
  DrawnPaths paths;
  std::vector<std::vector<int>> steps;  // [draw][person]: how many; empty where feet do not step
};

// What is wrong with drawing from a model: nothing in it is spread.
MaybeError CheckDrawsFrom(const IdentifiedModel& model);

// num_frames: 0 means as many as the recording has. Errors: as CheckDrawsFrom.
Result<Futures> DrawFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                            int draws, uint64_t seed, int num_frames = 0);

// For scores over recordings, whose draws are to be independent.
uint64_t SeedOfRecording(uint64_t seed, int recording);

// The hip of everybody at the last frame: median and central 90 % of the draws; shares of draws by
// number of steps.
std::string LastFrameText(const Futures& futures);

}  // namespace pushid
