// datasets: Human3.6M in its exponential-map text: its skeleton, and the test windows of its pairs
// of clips.
#include <random>

#include "datasets/loading/mocap_folder.h"

namespace pushid {
namespace {

constexpr int kTestSeed36 = 1234567890, kPairs = 4;
constexpr int kFirstStart = 16, kPrefix = 50, kSuffix = 100;  // frames

}  // namespace

// Parents and offsets as the literature's forward kinematics has them. Of 32 joints ten are hips'
// roots, or stand where another does.
const char* Human36mSkeleton() {
  return R"({
  "joints": 32,
  "parents": [-1, 0, 1, 2, 3, 4, 0, 6, 7, 8, 9, 0, 11, 12, 13, 14, 12, 16, 17, 18, 19, 20, 19, 22,
    12, 24, 25, 26, 27, 28, 27, 30],
  "offsets_mm": [[0, 0, 0], [-132.948591, 0, 0], [0, -442.894612, 0], [0, -454.206447, 0],
    [0, 0, 162.767078], [0, 0, 74.999437], [132.948826, 0, 0], [0, -442.894413, 0],
    [0, -454.20659, 0], [0, 0, 162.767426], [0, 0, 74.999948], [0, 0.1, 0], [0, 233.383263, 0],
    [0, 257.077681, 0], [0, 121.134938, 0], [0, 115.002227, 0], [0, 257.077681, 0],
    [0, 151.034226, 0], [0, 278.882773, 0], [0, 251.733451, 0], [0, 0, 0], [0, 0, 99.999627],
    [0, 100.000188, 0], [0, 0, 0], [0, 257.077681, 0], [0, 151.031437, 0], [0, 278.892924, 0],
    [0, 251.72868, 0], [0, 0, 0], [0, 0, 99.999888], [0, 137.499922, 0], [0, 0, 0]],
  "used": [2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 21, 22, 25, 26, 27, 29, 30],
  "duplicates": {"16": 13, "20": 19, "23": 22, "24": 13, "28": 27, "31": 30},
  "mirror": "x -> -x; joints 1-5 <-> 6-10, 16-23 <-> 24-31"
})";
}

std::vector<std::pair<int, int>> PairedWindowStarts(int frames, int frames_of_other) {
  std::vector<std::pair<int, int>> starts;
  const auto range = [](int n) { return n - kPrefix - kSuffix - kFirstStart - 1; };
  if (range(frames) < 0 || range(frames_of_other) < 0) return starts;
  std::mt19937 random(kTestSeed36);
  const auto draw = [&random](int largest) {
    uint32_t mask = 0;
    while (mask < static_cast<uint32_t>(largest)) mask = 2 * mask + 1;
    if (mask == 0) return kFirstStart;
    uint32_t word = 0;
    do {
      word = static_cast<uint32_t>(random()) & mask;
    } while (word > static_cast<uint32_t>(largest));
    return kFirstStart + static_cast<int>(word);
  };
  for (int i = 0; i < kPairs; ++i) {
    const int first = draw(range(frames));
    starts.emplace_back(first, draw(range(frames_of_other)));
  }
  return starts;
}

}  // namespace pushid
