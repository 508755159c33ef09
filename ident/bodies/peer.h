// ident: the peer (motion_peer.h) as a file, and its scores.
#pragma once

#include <string>

#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "models/restoration/motion_peer.h"

namespace pushid {

inline constexpr char kPeerKind[] = "simlpe";

void AddTensors(const PeerWeights& weights, TensorList* tensors);
// Errors: another kind, missing or misshapen tensors.
Result<PeerWeights> MakePeer(const RestorationFile& file, const std::string& folder);
Result<PeerWeights> LoadPeer(const std::string& folder);

// "simlpe": over all frames, the 12 given ones among them without error; "simlpe_after_given": over
// the frames after them. A recording that is too short fails by name.
void ScorePeer(const PeerWeights& weights, const BodyRecording& recording, BodyScores* scores);

}  // namespace pushid
