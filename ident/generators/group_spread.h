// ident: whether what groups did lies among their sampled futures.
//
//   inside  share of people's frames after those seen in which the recorded hip's x lies between
//   the
//           smallest and the largest of n samples; (n - 1) / (n + 1) where they are drawn as the
//           truth is
//   width   between those two, m
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ident/generators/push_particles.h"

namespace pushid {

struct GroupSpread {
  int samples = 0;
  double inside = 0.0, width = 0.0;
};
GroupSpread SpreadOf(const LoadedGenerator& loaded, const std::vector<BodyRecording>& recordings,
                     int samples, uint64_t seed);

nlohmann::ordered_json ToJson(const GroupSpread& spread);
std::string SpreadText(const GroupSpread& spread);

}  // namespace pushid
