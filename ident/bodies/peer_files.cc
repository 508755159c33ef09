// ident: peers as files, and their scores.
#include "ident/bodies/peer_files.h"

#include <filesystem>

#include "datasets/files/number_text.h"
#include "ident/parameters/option_names.h"
#include "models/restoration/cvae_features.h"
#include "models/restoration/mrt_network.h"
#include "models/restoration/simlpe.h"

namespace pushid {
namespace {

constexpr double kPeerStep = 1.0 / kPeerRate;  // s

using MadePeer = Result<std::unique_ptr<Peer>>;

MadePeer MakeSimlpe(const RestorationFile&, const std::string&, TensorReader* reader) {
  return std::unique_ptr<Peer>(new SimlpePeer(TakeSimlpe(reader)));
}

MadePeer MakeMrt(const RestorationFile& file, const std::string& path, TensorReader* reader) {
  MrtSize size = MrtSize::kSmall;
  const std::string name = file.settings.value(kMrtSizeKey, NameOf(size));
  if (MaybeError error = ParseName(kMrtSizeKey, name, &size)) return Error{error->message, path};
  return std::unique_ptr<Peer>(new MrtPeer(TakeMrt(size, reader)));
}

struct PeerMaker {
  RestorationKind kind;
  MadePeer (*make)(const RestorationFile& file, const std::string& path, TensorReader* reader);
};

constexpr PeerMaker kPeerMakers[] = {
    {RestorationKind::kSimlpe, MakeSimlpe},
    {RestorationKind::kMrt, MakeMrt},
};

}  // namespace

Result<std::unique_ptr<Peer>> MakePeer(const RestorationFile& file, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "restoration.json").string();
  std::string known;
  for (const PeerMaker& maker : kPeerMakers) {
    known += (known.empty() ? "--kind=" : " or --kind=") + std::string(Name(maker.kind));
    if (maker.kind != file.kind) continue;
    TensorReader reader(file.tensors);
    MadePeer peer = maker.make(file, path, &reader);
    if (peer.ok() && !reader.problem().empty()) {
      return Error{reader.problem() + "; train again with this version", path};
    }
    return peer;
  }
  return Error{
      "the kind is " + Quoted(Name(file.kind)) + "; --peer takes what " + known + " trained", path};
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
  const std::string name(peer.name()), after_given = name + "_after_given";
  std::vector<BodyMotion> people;
  for (const BodyMotion& body : recording.bodies) people.push_back(AtPeerRate(body, dt));
  const int at_rate = static_cast<int>(people.front().size());
  if (at_rate <= given + 1) {
    BodyScore failed;
    failed.id = recording.pendulum.id;
    failed.frames = frames;
    failed.failure = "shorter than the " + std::to_string(given) + " frames that " + name +
                     " is given, and two more";
    for (const std::string& key : {name, after_given}) (*scores)[key].push_back(failed);
    return;
  }
  std::vector<BodyMotion> predicted;
  for (const BodyMotion& motion : peer.Continue(people, at_rate)) {
    predicted.push_back(Resampled(motion, kPeerStep, dt, frames));
  }
  const int after = static_cast<int>(given * kPeerStep / dt + 0.5);
  (*scores)[name].push_back(ScoreBodies(recording, predicted));
  (*scores)[after_given].push_back(ScoreBodies(recording, predicted, after));
}

}  // namespace pushid
