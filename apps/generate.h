// apps: parts of pushid-generate: windows of motion capture, and recorded groups, forecast and
// shown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/flags/generate_flags.h"
#include "ident/forecasts/social_report.h"
#include "ident/generators/push_particles.h"
#include "ident/model/identified_model.h"

namespace pushid {

// Windows of clips forecast, judged and shown. Returns the exit code.
int GenerateFromClips(const LoadedGenerator& loaded, const GenerateFlags& flags);

// The model of --physics; nothing where none is named.
std::optional<IdentifiedModel> LoadPhysics(const std::string& file);

// A recording's forecast by a generator of any kind, to its end or for `frames` frames in all;
// the generator gets physics that see as many frames.
std::vector<BodyMotion> GenerateWith(const LoadedGenerator& loaded, const BodyRecording& recording,
                                     const std::optional<IdentifiedModel>& physics, int frames = 0);

// The states of --states, or the built-in ones; writes --states_out.
SocialCues FlaggedCues(const GenerateFlags& flags, const std::vector<BodyRecording>& recordings);

// What --poses_out, --strip_out and --page_out ask for: everybody recorded, forecast, and the
// pendulums of the physics beside them; the page shows the figures too. Returns the files' names.
std::vector<std::string> ShowGroup(const LoadedGenerator& loaded, const GenerateFlags& flags,
                                   const BodyRecording& recording,
                                   const std::optional<IdentifiedModel>& physics,
                                   const std::vector<std::string>& figures);

}  // namespace pushid
