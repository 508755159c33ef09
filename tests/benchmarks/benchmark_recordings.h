// benchmarks: the 32 recordings of single people that everything is measured on.
//
// The published ones when they are here (PUSHID_RECORDINGS, or ../shared/fzj_push beside the
// working directory), synthetic ones of the same lengths, 39 to 106 frames, otherwise. Every
// benchmark's label says which.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/load_recordings.h"
#include "datasets/pendulum_recording.h"
#include "datasets/synthetic_recordings.h"

namespace pushid {

struct BenchmarkRecordings {
  std::string origin;  // "published" or "synthetic"
  std::vector<PendulumRecording> recordings;
};

inline std::vector<Recording> SyntheticOfPublishedLengths() {
  constexpr int kShortest = 39, kLongest = 106;
  SyntheticOptions options;
  options.recordings_per_subject = 8;
  options.frames = kLongest;
  options.joint_noise_m = 0.002;
  std::vector<Recording> recordings = Recordings(MakeSyntheticRecordings(options).value());
  const int last = static_cast<int>(recordings.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const int frames = kShortest + i * (kLongest - kShortest) / last;
    for (RecordedPerson& person : recordings[i].people) {
      person.hip.resize(frames);
      person.left_ankle.resize(frames);
      person.right_ankle.resize(frames);
    }
  }
  return recordings;
}

inline const BenchmarkRecordings& SinglePeople() {
  static const BenchmarkRecordings loaded = [] {
    const char* named = std::getenv("PUSHID_RECORDINGS");
    const std::filesystem::path root = named != nullptr ? named : "../shared/fzj_push";
    LoadOptions options;
    options.setting = "single";
    const auto published = LoadRecordings((root / "manifest.json").string(), options);
    BenchmarkRecordings result{published.ok() ? "published" : "synthetic", {}};
    for (const Recording& recording :
         published.ok() ? published.value() : SyntheticOfPublishedLengths()) {
      result.recordings.push_back(MakePendulumRecording(recording, SkeletonMapping::kExact));
    }
    return result;
  }();
  return loaded;
}

}  // namespace pushid
