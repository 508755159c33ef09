// apps: parts of pushid-generate: windows of motion capture, and recorded groups, forecast and
// shown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/mocap_folder.h"
#include "ident/forecasts/social_report.h"
#include "ident/generators/generator_files.h"
#include "ident/generators/push_particles.h"
#include "ident/model/identified_model.h"

namespace pushid {

// What the command line says.
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
  std::string json_out, poses_out, svg_out, html_out;

  bool Shows() const { return !poses_out.empty() || !svg_out.empty() || !html_out.empty(); }
};

// Poses of the strip.
inline constexpr int kStripPoses = 6;

// Windows of clips forecast, judged and shown. Returns the exit code.
int GenerateFromClips(const LoadedGenerator& loaded, const GenerateFlags& flags);

// The model of --physics; nothing where none is named.
std::optional<IdentifiedModel> LoadPhysics(const std::string& file);

// A recording's forecast by a generator of any kind, to its end or for `frames` frames in all;
// the generator gets physics that see as many frames.
std::vector<BodyMotion> GenerateWith(const LoadedGenerator& loaded, const BodyRecording& recording,
                                     const std::optional<IdentifiedModel>& physics, int frames = 0);

// The states of --states, or the built-in ones; writes --csv_out.
SocialCues FlaggedCues(const GenerateFlags& flags, const std::vector<BodyRecording>& recordings);

// What --poses_out, --svg_out and --html_out ask for: everybody recorded, forecast, and the
// pendulums of the physics beside them; the page shows the figures too. Returns the files' names.
std::vector<std::string> ShowGroup(const LoadedGenerator& loaded, const GenerateFlags& flags,
                                   const BodyRecording& recording,
                                   const std::optional<IdentifiedModel>& physics,
                                   const std::vector<std::string>& figures);

}  // namespace pushid
