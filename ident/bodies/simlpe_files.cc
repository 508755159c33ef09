// ident: siMLPe as a file, and its scores.
#include "ident/bodies/simlpe_files.h"

#include <filesystem>

#include "datasets/files/number_text.h"
#include "models/restoration/cvae_features.h"

namespace pushid {
namespace {
constexpr double kSimlpeRate = 60.0;  // Hz
}  // namespace

void AddTensors(const SimlpeWeights& weights, TensorList* tensors) {
  AddTensors("inputs", weights.inputs, tensors);
  AddTensors("network", weights.network, tensors);
}

Result<SimlpeWeights> MakeSimlpe(const RestorationFile& file, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "restoration.json").string();
  if (file.kind != RestorationKind::kSimlpe) {
    return Error{"the kind is " + Quoted(Name(file.kind)) +
                     "; --peer takes what --kind=" + Name(RestorationKind::kSimlpe) + " trained",
                 path};
  }
  TensorReader reader(file.tensors);
  SimlpeWeights weights;
  weights.inputs = TakeScaling("inputs", kSimlpeInputs, &reader);
  weights.network = TakeNetwork("network", 3, kSimlpeInputs, kSimlpeOutputs, &reader);
  if (!reader.problem().empty()) {
    return Error{reader.problem() + "; train again with this version", path};
  }
  return weights;
}

Result<SimlpeWeights> LoadSimlpe(const std::string& folder) {
  const Result<RestorationFile> file = ReadRestorationFile(folder);
  if (!file.ok()) return file.error();
  return MakeSimlpe(file.value(), folder);
}

void ScoreSimlpe(const SimlpeWeights& weights, const BodyRecording& recording, BodyScores* scores) {
  const double dt = recording.pendulum.scene.dt, simlpe_dt = 1.0 / kSimlpeRate;
  const int frames = recording.num_frames();
  const int at_rate = static_cast<int>((frames - 1) * dt / simlpe_dt + 0.5) + 1;
  if (at_rate <= kGivenFrames + 1) {
    BodyScore failed;
    failed.id = recording.pendulum.id;
    failed.frames = frames;
    failed.failure = "shorter than the 12 frames that siMLPe is given";
    for (const char* name : {"simlpe", "simlpe_after_given"}) (*scores)[name].push_back(failed);
    return;
  }
  std::vector<BodyMotion> predicted;
  for (const BodyMotion& body : recording.bodies) {
    const BodyMotion given = Resampled(body, dt, simlpe_dt, at_rate);
    predicted.push_back(Resampled(ContinueMotion(weights, given, at_rate), simlpe_dt, dt, frames));
  }
  const int after = static_cast<int>(kGivenFrames * simlpe_dt / dt + 0.5);
  (*scores)["simlpe"].push_back(ScoreBodies(recording, predicted));
  (*scores)["simlpe_after_given"].push_back(ScoreBodies(recording, predicted, after));
}

}  // namespace pushid
