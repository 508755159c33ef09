// ident: the peer.
#include "ident/bodies/peer.h"

#include <filesystem>

#include "datasets/files/number_text.h"
#include "models/restoration/cvae_features.h"

namespace pushid {
namespace {
constexpr double kPeerRate = 60.0;  // Hz
}  // namespace

void AddTensors(const PeerWeights& weights, TensorList* tensors) {
  AddTensors("inputs", weights.inputs, tensors);
  AddTensors("network", weights.network, tensors);
}

Result<PeerWeights> MakePeer(const RestorationFile& file, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "restoration.json").string();
  if (file.kind != kPeerKind) {
    return Error{"the kind is " + Quoted(file.kind) + "; --peer takes what --kind=simlpe trained",
                 path};
  }
  TensorReader reader(file.tensors);
  PeerWeights weights;
  weights.inputs = TakeScaling("inputs", kPeerInputs, &reader);
  weights.network = TakeNetwork("network", 3, kPeerInputs, kPeerOutputs, &reader);
  if (!reader.problem().empty()) {
    return Error{reader.problem() + "; train again with this version", path};
  }
  return weights;
}

Result<PeerWeights> LoadPeer(const std::string& folder) {
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return MakePeer(file.value(), folder);
}

void ScorePeer(const PeerWeights& weights, const BodyRecording& recording, BodyScores* scores) {
  const double dt = recording.pendulum.scene.dt, peer_dt = 1.0 / kPeerRate;
  const int frames = recording.num_frames();
  const int at_rate = static_cast<int>((frames - 1) * dt / peer_dt + 0.5) + 1;
  if (at_rate <= kGivenFrames + 1) {
    BodyScore failed;
    failed.id = recording.pendulum.id;
    failed.frames = frames;
    failed.failure = "shorter than the 12 frames that the peer is given";
    for (const char* name : {"simlpe", "simlpe_after_given"}) (*scores)[name].push_back(failed);
    return;
  }
  std::vector<BodyMotion> predicted;
  for (const BodyMotion& body : recording.bodies) {
    const BodyMotion given = Resampled(body, dt, peer_dt, at_rate);
    predicted.push_back(Resampled(ContinueMotion(weights, given, at_rate), peer_dt, dt, frames));
  }
  const int after = static_cast<int>(kGivenFrames * peer_dt / dt + 0.5);
  (*scores)["simlpe"].push_back(ScoreBodies(recording, predicted));
  (*scores)["simlpe_after_given"].push_back(ScoreBodies(recording, predicted, after));
}

}  // namespace pushid
