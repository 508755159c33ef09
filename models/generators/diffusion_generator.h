// models: groups continued by diffusion. The people of a call are one group, at one rate, whose
// frame 0 is the first that was seen; the push is what acts on any of them (their controls).
//
// From noise at T to nothing of it in some steps; frames that were seen are put in the place of
// what the network estimates for them, after every step (Eq. 6 of SDM). Networks of several seeds
// take turns, sample by sample. The forecast is the mean of several samples, as the mean joint
// error asks for. Recordings end before people stand still: past the longest one learnt from, what
// the network has them go on with fades, and they come to rest. Sampled futures may
// each be pushed a little harder or less, which stands for what differs between recordings of like
// pushes. With a pendulum's path its people are moved some of the way to it. Then each body
// is finished as restored ones are (postprocess.h): the seam at the last frame seen fades, bones
// keep the length of frame 0, resting feet stay.
//
// Noise belongs to people by their place, not by their number, so that their order changes nothing.
#pragma once

#include <functional>
#include <vector>

#include "models/generators/diffusion_network.h"
#include "models/generators/diffusion_schedule.h"
#include "models/restoration/postprocess.h"

namespace pushid {

struct DiffusionGeneratorOptions {
  DiffusionSampler sampler = DiffusionSampler::kRenoised;
  int steps = 25;
  int averaged = 8;          // samples of a forecast
  int learnt_frames = 128;   // of the longest motion learnt from; later ones settle
  double settling = 0.5;     // s, in which steps of later frames fade to 1/e
  double blend = 0.0;        // share of the way to the pendulum's hip
  double push_spread = 0.8;  // of the logarithm of the push, between sampled futures
  PostprocessOptions postprocess = {true, 20};
};

class DiffusionGenerator : public MotionGenerator {
 public:
  // noise: makes a source that begins anew, for forecasts that repeat themselves; dt: s.
  DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members, double dt,
                     const DiffusionGeneratorOptions& options, std::function<NormalSource()> noise);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource& normal) const override;

 private:
  // Everybody's motion, with what the network makes of the frames seen, before it is finished.
  std::vector<Trajectories> SampleWhole(const std::vector<ObservedMotion>& people,
                                        const DiffusionNetwork& network, int frames,
                                        const NormalSource& normal) const;
  // Networks take turns.
  const DiffusionNetwork& Member(int sample) const { return members_[sample % members_.size()]; }
  // The frames after those seen.
  Trajectories Finished(const ObservedMotion& person, Trajectories motion) const;

  ParticleLayout layout_;
  std::vector<DiffusionNetwork> members_;
  double dt_;
  DiffusionGeneratorOptions options_;
  std::function<NormalSource()> noise_;
};

}  // namespace pushid
