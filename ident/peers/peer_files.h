// ident: peers (models/peers/peer.h) as files, and their scores.
#pragma once

#include <memory>
#include <string>

#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "models/peers/peer.h"

namespace pushid {

// In RestorationFile::settings, of kMrt: a name of MrtSize. Files of before have none.
inline constexpr char kMrtSizeKey[] = "size";

// Errors: a kind that is no peer, a size of MRT that is none, missing or misshapen tensors.
Result<std::unique_ptr<Peer>> MakePeer(const RestorationFile& file, const std::string& folder);
Result<std::unique_ptr<Peer>> LoadPeer(const std::string& folder);

// A motion of frames dt apart at kPeerRate, as long as it is.
BodyMotion AtPeerRate(const BodyMotion& motion, double dt);

// "<name>": over the frames that were not given; "<name>_all_frames": over all, the given ones
// among them without error. A recording that is too short fails by name.
void ScorePeer(const Peer& peer, const BodyRecording& recording, BodyScores* scores);

}  // namespace pushid
