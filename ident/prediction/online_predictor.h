// ident: a prediction that learns from every frame it is shown.
//
//   auto predictor = OnlinePredictor::Make(model, scene, 120);   // frames to look ahead, in all
//   while (camera.Next()) {
//     predictor.value().Observe(people);
//     const Prediction prediction = predictor.value().Predict();
//   }
//
// The forecasters, and how they are put together: observed/first_frames.h. Frames that
// were seen are in the prediction as they were. From then on hips and leans are forecast, and the
// cart is where the rod puts it; forces, steps and a moving rod are the rollout's. Before
// anything is seen the prediction is that of Predict, to the bit. Every forecast needs that
// rollout: where it leaves the domain, nothing is predicted.
//
// A controller without a last frame makes the predictor with kEndless, reports measured pushes with
// Push, and calls Next for the frames ahead; its cost does not depend on the number of frames seen.
#pragma once

#include <memory>

#include "datasets/files/error.h"
#include "ident/observed/first_frames.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// Errors: a model that has learned no forecasts.
MaybeError CheckLearnsFromFrames(const IdentifiedModel& model);

class OnlinePredictor {
 public:
  static constexpr int kEndless = -1;  // a number of frames, for Next alone: Predict has none then

  // recording: people, pushes and frame 0; its later frames are not looked at. Both must outlive
  // the predictor. Errors: those of CheckLearnsFromFrames; a filter that there is not.
  static Result<OnlinePredictor> Make(const IdentifiedModel& model,
                                      const PendulumRecording& recording, int num_frames,
                                      ForecastUse use = ForecastUse::kBoth);

  // Pushes a person from the last frame until the next one, in addition to the recording's pushes:
  // N, N m. It changes the predicted hips, but not the lean, forces and steps of Predict.
  void Push(int person, const Vector4<double>& force) { frames_->Push(person, force); }
  // The next frame, frame 1 first; nothing once all frames were seen.
  void Observe(const SeenFrame& frame);
  int observed() const { return frames_->observed(); }  // with frame 0
  // A prediction without bands, which take longer to compute than all other parts.
  Prediction Predict() const;
  // The hips of all people in the next `ahead` frames, equal to those of Predict; empty if the
  // forecasts leave the domain.
  HipPaths Next(int ahead) const;
  // The distribution of the hips behind those seen, in a prediction that did not fail.
  HipDistribution Distribution(const Prediction& prediction) const;

 private:
  OnlinePredictor(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames,
                  ForecastUse use);
  std::optional<double> Share(const TwoForecasts& two) const;
  void SetForecast(const TwoForecasts& two, double input_share, Prediction* prediction) const;

  const IdentifiedModel* model_;
  const PendulumRecording* recording_;
  ForecastUse use_;
  int num_frames_;
  Prediction rollout_;                // of all frames; those seen are as they were
  std::vector<Eigen::Vector2d> off_;  // by person: seen lean less the rollout's at the last frame
  std::unique_ptr<FirstFrames> frames_;
};

// A prediction with bands from the first `observed` frames of a recording. num_frames: 0 means as
// many as the recording has, otherwise more than observed. observed 0: as Predict.
Result<Prediction> PredictFrom(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed, int num_frames = 0,
                               ForecastUse use = ForecastUse::kBoth);

}  // namespace pushid
