// benchmarks: the recordings that everything is measured on: 32 of single people, 49 of groups.
//
// The published ones when they are here (PUSHID_RECORDINGS, or ../shared/fzj_push beside the
// working directory), synthetic ones of the same lengths, 39 to 106 frames, otherwise. Every
// benchmark's label says which.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"

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

// Rows of five, as many and as long as the published groups.
inline std::vector<Recording> SyntheticGroups() {
  SyntheticOptions options;
  options.model.interaction.spring = options.model.interaction.damping = true;
  options.parameters[kContactStiffness] = 2900.0, options.parameters[kContactDistance] = 0.42;
  options.parameters[kContactKappa] = 0.41, options.parameters[kContactDamping] = 270.0;
  options.parameters[kContactHeight] = 0.5;
  options.subjects = options.recordings_per_subject = 7;
  options.people_in_row = 5;
  options.frames = 75;
  options.joint_noise_m = 0.002;
  return Recordings(MakeSyntheticRecordings(options).value());
}

// setting: "single" or "groups".
inline BenchmarkRecordings LoadForBenchmarks(const std::string& setting) {
  const char* named = std::getenv("PUSHID_RECORDINGS");
  const std::filesystem::path root = named != nullptr ? named : "../shared/fzj_push";
  LoadOptions options;
  options.setting = setting;
  const auto published = LoadRecordings((root / "manifest.json").string(), options);
  BenchmarkRecordings result{published.ok() ? "published" : "synthetic", {}};
  for (const Recording& recording : published.ok()        ? published.value()
                                    : setting == "groups" ? SyntheticGroups()
                                                          : SyntheticOfPublishedLengths()) {
    result.recordings.push_back(MakePendulumRecording(recording));
  }
  return result;
}

inline const BenchmarkRecordings& SinglePeople() {
  static const BenchmarkRecordings loaded = LoadForBenchmarks("single");
  return loaded;
}

inline const BenchmarkRecordings& Groups() {
  static const BenchmarkRecordings loaded = LoadForBenchmarks("groups");
  return loaded;
}

}  // namespace pushid
