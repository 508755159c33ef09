// ident: samples for restoration networks.
#include "ident/training/restoration_data.h"

#include <algorithm>
#include <cmath>

#include "ident/fit/fit.h"
#include "ident/prediction/prediction.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {
namespace {

std::vector<PendulumRecording> Chosen(const std::vector<PendulumRecording>& recordings,
                                      const std::vector<int>& indices) {
  std::vector<PendulumRecording> chosen;
  for (int i : indices) chosen.push_back(recordings[i]);
  return chosen;
}

}  // namespace

std::optional<IdentifiedModel> FitTo(const std::vector<PendulumRecording>& recordings,
                                     const std::vector<int>& train, const FitOptions& options) {
  Result<SolvedModel> solved = SolveModel(Chosen(recordings, train), options);
  if (!solved.ok()) return std::nullopt;
  return std::move(solved.value().model);
}

std::vector<RolloutPath<double>> PredictOutOfFold(const std::vector<PendulumRecording>& recordings,
                                                  const std::vector<int>& among,
                                                  const FitOptions& options, int folds,
                                                  uint64_t seed,
                                                  const OutOfFoldProgress& progress) {
  const int total = static_cast<int>(among.size());
  std::vector<RolloutPath<double>> paths(total);
  if (total < 2) return paths;
  const auto made = MakeFolds(Chosen(recordings, among), FoldScheme::kStratified,
                              std::min(folds, total), 1, seed);
  if (!made.ok()) return paths;
  int done = 0;
  for (const Fold& fold : made.value()) {
    if (progress) progress(done++, static_cast<int>(made.value().size()));
    std::vector<int> train;
    for (int k = 0; k < total; ++k) {
      const bool held = std::binary_search(fold.held_out.begin(), fold.held_out.end(), k);
      if (!held) train.push_back(among[k]);
    }
    const std::optional<IdentifiedModel> model = FitTo(recordings, train, options);
    if (!model) continue;
    for (int k : fold.held_out) {
      Prediction prediction = Predict(*model, recordings[among[k]]);
      if (prediction.status.ok) paths[k] = std::move(prediction.path);
    }
  }
  return paths;
}

std::vector<RestorationSample> MakeSamples(const std::vector<BodyRecording>& recordings,
                                           const std::vector<int>& among,
                                           const std::vector<RolloutPath<double>>& paths,
                                           bool mirrored) {
  std::vector<RestorationSample> samples;
  const auto add = [&](const BodyRecording& recording, std::vector<RestorationInput> people) {
    const double weight = 100.0 / (recording.num_people() * recording.num_frames());
    std::vector<RestorationInput> others;
    for (const RestorationInput& person : people) others.push_back(Mirrored(person));
    const auto seen = std::make_shared<const std::vector<RestorationInput>>(std::move(people));
    const auto other = std::make_shared<const std::vector<RestorationInput>>(std::move(others));
    for (int n = 0; n < recording.num_people(); ++n) {
      samples.push_back({seen, n, recording.bodies[n], weight});
      if (!mirrored) continue;
      BodyMotion motion;
      for (const Pose& pose : recording.bodies[n]) motion.push_back(Mirrored(pose));
      samples.push_back({other, n, std::move(motion), weight});
    }
  };
  for (size_t k = 0; k < among.size(); ++k) {
    const BodyRecording& recording = recordings[among[k]];
    add(recording, RecordedPeople(recording));
    if (k >= paths.size() || paths[k].num_frames() == 0) continue;
    add(recording, PredictedPeople(recording, paths[k]));
  }
  return samples;
}

void SplitHeldOut(const std::vector<PendulumRecording>& recordings, const std::vector<int>& among,
                  double share, uint64_t seed, std::vector<int>* training, std::vector<int>* held) {
  const int total = static_cast<int>(among.size());
  const int folds = std::clamp(static_cast<int>(std::lround(1.0 / share)), 2, std::max(2, total));
  const auto made = MakeFolds(Chosen(recordings, among), FoldScheme::kStratified, folds, 1, seed);
  training->clear(), held->clear();
  for (int k = 0; k < total; ++k) {
    const bool out = made.ok() && std::binary_search(made.value()[0].held_out.begin(),
                                                     made.value()[0].held_out.end(), k);
    (out ? held : training)->push_back(k);
  }
}

}  // namespace pushid
