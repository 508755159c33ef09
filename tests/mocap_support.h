// Motion-capture clips in tests: synthetic ones of four joints, and the real ones if available.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/test_support.h"

namespace pushid {

// The folder of the real clips; "" if there are none, in which case a test skips itself.
inline std::string MocapRoot() {
  return SharedFolder("PUSHID_MOCAP", "cmu_mocap", "skeleton.json");
}

constexpr char kNoMocap[] = "the real clips are not here; name their folder by PUSHID_MOCAP";

// A root, a spine, and an arm on each side; joint 5 is at the place of joint 1.
constexpr char kSmallSkeleton[] = R"({
  "joints": 6, "parents": [-1, 0, 1, 2, 2, 1],
  "offsets_mm": [[0, 0, 0], [0, 500, 0], [0, 300, 0], [200, 0, 0], [-200, 0, 0], [0, 0, 0]],
  "used": [1, 2, 3, 4], "duplicates": {"5": 1},
  "mirror": "x -> -x; joints 3-3 <-> 4-4"
})";

// The spine sways in two planes; size: amplitude.
inline std::string SmallClip(int frames, double size, double phase) {
  std::string text;
  for (int t = 0; t < frames; ++t) {
    for (int i = 0; i < 21; ++i) {
      double value = 0.0;
      if (i == 6) value = size * std::sin(0.11 * t + phase);
      if (i == 8) value = size * std::sin(0.07 * t + 2.0 * phase);
      if (i == 10) value = 0.5 * size * std::cos(0.13 * t + phase);
      text += (i == 0 ? "" : ",") + std::to_string(value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace pushid
