// ident: whether what groups did lies among their sampled futures.
//
//   inside  share of people's frames after those seen in which the recorded hip's x lies between
//           the smallest and the largest of n samples; (n - 1) / (n + 1) where they are drawn as
//           the truth is
//   width   between those two, m
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ident/generators/push_particles.h"

namespace pushid {

struct GroupSpread {
  int samples = 0;
  double frames = 0.0, inside_sum = 0.0, width_sum = 0.0;

  double Inside() const { return inside_sum / std::max(1.0, frames); }
  double Width() const { return width_sum / std::max(1.0, frames); }
};

// Adds a recording of which the first `observed` frames are seen; hips: of physics, or none.
void AddSpread(const MotionGenerator& generator, const BodyRecording& recording,
               const GroupHips& hips, int observed, const NormalSource& normal,
               GroupSpread* spread);

nlohmann::ordered_json ToJson(const GroupSpread& spread);
std::string SpreadText(const GroupSpread& spread);

}  // namespace pushid
