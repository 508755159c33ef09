// Synthetic people who talk in turns, with the truth of their states.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/generator_data.h"
#include "datasets/loading/load_recordings.h"
#include "ident/bodies/body_recording.h"
#include "tests/simulators/synthetic_clips.h"
#include "tests/test_support.h"

namespace pushid {

class TurnsTest : public TempDirTest {
 protected:
  std::vector<BodyRecording> MakeTurns(const SyntheticTurnsOptions& options) {
    if (MaybeError failed = WriteSyntheticTurns(Path("turns"), options)) {
      ADD_FAILURE() << failed->ToString();
      return {};
    }
    LoadOptions load;
    load.keep_all_joints = true;
    const auto recordings = LoadRecordings(Path("turns/manifest.json"), load);
    if (!recordings.ok()) {
      ADD_FAILURE() << recordings.error().ToString();
      return {};
    }
    auto bodies = MakeBodyRecordings(recordings.value());
    if (!bodies.ok()) ADD_FAILURE() << bodies.error().ToString();
    return bodies.ok() ? bodies.value() : std::vector<BodyRecording>();
  }
  StateTable Truth() { return ReadStates(Path("turns/states.csv")).value(); }
};

inline std::vector<std::string> IdsOf(const std::vector<BodyRecording>& recordings) {
  std::vector<std::string> ids;
  for (const BodyRecording& recording : recordings) ids.push_back(recording.pendulum.id);
  return ids;
}

}  // namespace pushid
