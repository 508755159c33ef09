// apps: the flags of pushid-generate.
#pragma once

#include <string>

#include "datasets/loading/mocap_folder.h"
#include "ident/generators/generator_files.h"

namespace pushid {

struct GenerateFlags {
  std::string model;   // folder of the generator
  std::string folder;  // of clips
  GeneratorChanges changes;
  ForecastProtocol protocol = ForecastProtocol::kValidation;
  int samples = 0;                 // futures of every window; 0: none
  uint64_t seed = 1;               // of the samples
  std::string action;              // of the window to show; empty: the first
  int window = 0;                  // which of the action's
  std::string id;                  // of the recording to show
  int observed = 0;                // frames shown to diffusion; 0: as it was made for
  int frames = 0;                  // of the shown motion in all; 0: as many as the recording
  std::string states, states_out;  // files of states of people; empty: none
  std::string physics;             // file of a model; empty: none
  int target_window = -1;          // whose end is the target of the path search; -1: none
  std::string json_out, poses_out, strip_out, page_out;

  bool Shows() const { return !poses_out.empty() || !strip_out.empty() || !page_out.empty(); }
};
GenerateFlags GenerateFlagsFromCommandLine();

// Errors: flags that say something to generators of the other kind alone, or that this kind needs.
void CheckKindFlags(const GenerateFlags& flags, GeneratorKind kind);

// Poses of the strip.
inline constexpr int kStripPoses = 6;

}  // namespace pushid
