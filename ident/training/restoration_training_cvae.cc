// ident: samples to sequences of scaled frames, rounds, checkpoints.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/training/restoration_training_kinds.h"
#include "models/restoration/cvae_trainer.h"

namespace pushid {
namespace {

std::vector<CvaeSequence> Sequences(const std::vector<RestorationSample>& samples,
                                    const CvaeLayout& layout) {
  std::vector<CvaeSequence> sequences;
  for (const RestorationSample& sample : samples) {
    const RestorationInput person = Resampled(sample.person(), 1.0 / kCvaeRate);
    const BodyMotion motion =
        Resampled(sample.motion, sample.person().dt, person.dt, static_cast<int>(person.q.size()));
    BodyFrames frames = FramesOf(person, motion, layout);
    sequences.push_back(
        {std::move(frames.lower), std::move(frames.upper), PendulumFrames(person, layout)});
  }
  return sequences;
}

Scaling ScalingOfAll(const std::vector<CvaeSequence>& sequences,
                     Eigen::MatrixXf CvaeSequence::*part) {
  Eigen::Index columns = 0, at = 0;
  for (const CvaeSequence& s : sequences) columns += (s.*part).cols();
  Eigen::MatrixXf all((sequences.front().*part).rows(), columns);
  for (const CvaeSequence& s : sequences) {
    all.middleCols(at, (s.*part).cols()) = s.*part;
    at += (s.*part).cols();
  }
  return ScalingOf(all);
}

void Scale(const CvaeWeights& scalings, std::vector<CvaeSequence>* sequences) {
  for (CvaeSequence& s : *sequences) {
    s.lower = scalings.lower.Scaled(s.lower);
    if (scalings.layout.halves) s.upper = scalings.upper.Scaled(s.upper);
    if (scalings.layout.pendulum) s.pendulum = scalings.pendulum.Scaled(s.pendulum);
  }
}

}  // namespace

Result<TrainedRestoration> TrainCvae(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options,
                                     const TrainingProgress& progress) {
  CvaeWeights scalings;
  scalings.layout = {options.coordinates, options.view == RestorationView::kPendulum,
                     options.halves};
  std::vector<CvaeSequence> learnt = Sequences(training, scalings.layout);
  std::vector<CvaeSequence> judged = Sequences(held, scalings.layout);
  scalings.lower = ScalingOfAll(learnt, &CvaeSequence::lower);
  if (scalings.layout.halves) scalings.upper = ScalingOfAll(learnt, &CvaeSequence::upper);
  if (scalings.layout.pendulum) scalings.pendulum = ScalingOfAll(learnt, &CvaeSequence::pendulum);
  Scale(scalings, &learnt);
  Scale(scalings, &judged);
  CvaeOptions cvae;
  for (int& steps : cvae.steps) {
    steps = std::max(1, static_cast<int>(std::lround(steps * options.effort)));
  }
  cvae.seed = options.seed;
  cvae.num_threads = options.num_threads;
  CvaeTrainer trainer(std::move(learnt), std::move(judged), scalings, cvae);
  TrainedRestoration trained;
  if (MaybeError error = RunRounds(
          &trainer, [&trainer] { return trainer.RunRound(); },
          [&trainer](const TrainingPoint&) { return trainer.ShareDone(); },
          KeyOfTraining(training, held, options), options, progress, &trained)) {
    return *error;
  }
  trained.file.tensors = ToTensors(trainer.Best());
  *trained.file.settings = {{kViewKey, NameOf(options.view)},
                            {kCvaeCoordinatesKey, Name(options.coordinates)},
                            {kCvaeHalvesKey, options.halves}};
  return trained;
}

}  // namespace pushid
