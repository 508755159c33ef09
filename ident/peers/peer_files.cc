// ident: peers as files, and their scores.
#include "ident/peers/peer_files.h"

#include <nlohmann/json.hpp>

#include "ident/bodies/restoration_files.h"
#include "ident/parameters/option_names.h"
#include "models/peers/mrt_network.h"
#include "models/restoration/cvae_features.h"

namespace pushid {
namespace {

constexpr double kPeerStep = 1.0 / kPeerRate;  // s

}  // namespace

Result<std::unique_ptr<Peer>> MakeMrt(const RestorationFile& file, const std::string& path,
                                      TensorReader* reader) {
  MrtSize size = MrtSize::kSmall;
  const std::string name = file.settings->value(kMrtSizeKey, NameOf(size));
  if (MaybeError error = ParseName(kMrtSizeKey, name, &size)) return Error{error->message, path};
  return std::unique_ptr<Peer>(new MrtPeer(TakeMrt(size, reader)));
}

Result<std::unique_ptr<Peer>> MakePeer(const RestorationFile& file, const std::string& folder) {
  return MakeByKind(kPeerMakers, file, RestorationJsonFile(folder),
                    "what follows a pendulum is named by --restoration");
}

Result<std::unique_ptr<Peer>> LoadPeer(const std::string& folder) {
  const Result<RestorationFile> file = ReadRestorationFile(folder, "--peer");
  if (!file.ok()) return file.error();
  return MakePeer(file.value(), folder);
}

BodyMotion AtPeerRate(const BodyMotion& motion, double dt) {
  const double end = static_cast<double>(motion.size() - 1) * dt;
  return Resampled(motion, dt, kPeerStep, static_cast<int>(end / kPeerStep + 0.5) + 1);
}

void ScorePeer(const Peer& peer, const BodyRecording& recording, BodyScores* scores) {
  const double dt = recording.pendulum.scene.dt;
  const int frames = recording.num_frames(), given = peer.given_frames();
  const std::string name(peer.name()), all_frames = name + "_all_frames";
  std::vector<BodyMotion> people;
  for (const BodyMotion& body : recording.bodies) people.push_back(AtPeerRate(body, dt));
  const int at_rate = static_cast<int>(people.front().size());
  if (at_rate <= given + 1) {
    const BodyScore failed =
        FailedBodies(recording, "shorter than the " + std::to_string(given) + " frames that " +
                                    name + " is given, and two more");
    for (const std::string& key : {name, all_frames}) (*scores)[key].push_back(failed);
    return;
  }
  std::vector<BodyMotion> predicted;
  for (const BodyMotion& motion : peer.Continue(people, at_rate)) {
    predicted.push_back(Resampled(motion, kPeerStep, dt, frames));
  }
  const int after = static_cast<int>(given * kPeerStep / dt + 0.5);
  (*scores)[name].push_back(ScoreBodies(recording, predicted, after));
  (*scores)[all_frames].push_back(ScoreBodies(recording, predicted));
}

}  // namespace pushid
