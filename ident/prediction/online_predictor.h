// ident: a prediction that learns from every frame it is shown.
//
//   auto predictor = OnlinePredictor::Make(model, scene, 120);   // frames to look ahead, in all
//   while (camera.Next()) {
//     predictor.value().Observe(people);                         // a few microseconds
//     const Prediction prediction = predictor.value().Predict(); // one rollout
//   }
//
// What is learned and how stands in fit/recording_effect.h. Frames that were seen are in the
// prediction as they were. From then on hips are forecast, angles come back to the rollout's as an
// error of velocity dies out, and the cart is where the rod puts it; forces, steps and a moving rod
// are the rollout's. Before anything is seen the prediction is that of Predict, to the bit.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/random.h"
#include "ident/fit/recording_filter.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// Where hips will be, as mixtures of normal distributions: one component for each node of
// the recording's effect (fit/recording_effect.h).
//
// NormalCdf: of the standard normal distribution.
double NormalCdf(double x);

class HipDistribution {
 public:
  // Of the frames that the filter has not seen. centre: what is predicted of them; the mixture is
  // moved there, and widened by what the effect says of the time seen.
  HipDistribution(const RecordingFilter& filter, const RecordingEffect& effect,
                  const HipPaths& centre);

  int num_people() const { return static_cast<int>(points_.size()); }
  int num_frames() const { return points_.empty() ? 0 : static_cast<int>(points_[0].size()); }

  // frame: 0 is the first that was not seen; axis: 0 x, 1 y, 2 z.
  double Cdf(int person, int frame, int axis, double value) const;
  double Quantile(int person, int frame, int axis, double share) const;
  // One future: a component, and how far from its middle each person goes on each axis, in
  // deviations. Frame by frame draws are spread as the distribution says; a person who is far out
  // stays so, as errors of velocity do, which add up.
  HipPaths Draw(Random* random) const;

 private:
  std::vector<double> weights_;
  std::vector<std::vector<MixturePoint>> points_;  // on the world's axes
};

// Everybody at one frame.
struct SeenFrame {
  SeenHips hips;
  std::vector<PendulumState<double>> states;
};
SeenFrame FrameAt(const PendulumRecording& recording, int frame);

// Errors: a model that knows nothing of how recordings differ.
MaybeError CheckLearnsFromFrames(const IdentifiedModel& model);

class OnlinePredictor {
 public:
  // recording: people, pushes and frame 0; its later frames are not looked at. Both must outlive
  // the predictor. Errors: those of CheckLearnsFromFrames; a rollout that leaves the domain
  // whatever the effect.
  static Result<OnlinePredictor> Make(const IdentifiedModel& model,
                                      const PendulumRecording& recording, int num_frames);

  // The next frame, frame 1 first; nothing once all frames were seen.
  void Observe(SeenFrame frame);
  int observed() const { return filter_->observed(); }  // with frame 0
  EffectEstimate effect() const;
  // Without bands, which take longer than all the rest.
  Prediction Predict() const;
  // Of the hips behind those seen in a prediction that did not fail.
  HipDistribution Distribution(const Prediction& prediction) const;

 private:
  OnlinePredictor(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames);

  const IdentifiedModel* model_;
  const PendulumRecording* recording_;
  std::unique_ptr<RecordingFilter> filter_;
  std::vector<SeenFrame> seen_;
};

// From the first `observed` frames of a recording, with bands. num_frames: 0 means as many as the
// recording has, otherwise more than observed. observed 0: as Predict.
Result<Prediction> PredictFrom(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed, int num_frames = 0);

// Hips of futures drawn from the distribution behind those bands, by [draw][person][frame]; frames
// that were seen are as they were. observed: at least 1 (frame 0 alone: what recordings differ by).
Result<std::vector<HipPaths>> DrawFrom(const IdentifiedModel& model,
                                       const PendulumRecording& recording, int observed, int draws,
                                       uint64_t seed, int num_frames = 0);

// "tail 1.2 times that of the mean recording (b 0.18 +- 0.21), from 12 frames"; empty where nothing
// was seen.
std::string EffectText(const Prediction& prediction);

}  // namespace pushid
