// models: groups continued by diffusion. The people of a call are one group, at one rate, whose
// frame 0 is the first that was seen; the push is what acts on any of them (their controls).
//
// From noise at T to hardly any in some steps; frames that were seen are put in the place of
// what the network estimates for them, after every step (Eq. 6 of SDM). Networks of several seeds
// take turns, sample by sample. The forecast is the mean of several samples, as the mean joint
// error asks for, half of them of the group in the mirror, where the network errs otherwise.
// Recordings end before people stand still: past the longest one learnt from, what
// the network has them go on with fades, and they come to rest. With a pendulum's path its people
// are moved some of the way to it. Then each body is finished as restored ones are (postprocess.h):
// the seam at the last frame seen fades, bones keep the length of frame 0, resting feet stay.
//
// Noise belongs to people by their place, not by their number, so that their order changes nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "models/enum_names.h"
#include "models/generators/diffusion_network.h"
#include "models/restoration/postprocess.h"

namespace pushid {

// How much of a motion is left after t of T steps of forward noise, and the way back.
//
//   x_t = sqrt(a_t) x_0 + sqrt(1 - a_t) e,  e ~ N(0, 1)
//   a_t = f(t) / f(0),  f(t) = cos^2((t / T + s) / (1 + s) pi / 2)   the cosine schedule, s = 0.008
//
// The network estimates x_0 itself. From an estimate at t to an earlier time u < t:
//
//   renoised   x_u = sqrt(a_u) x_0 + sqrt(1 - a_u) e, e drawn anew (Eq. 5 of SDM)
//   ddpm       the posterior of x_u given x_t and x_0

enum class DiffusionSampler { kRenoised, kDdpm };
constexpr EnumNames<DiffusionSampler, 2> Names(DiffusionSampler) {
  return {{{"renoised", DiffusionSampler::kRenoised}, {"ddpm", DiffusionSampler::kDdpm}}};
}

inline constexpr int kDiffusionTime = 1000;  // T

// a_t; 1 at t = 0, 0 at t = T.
inline double SignalShare(double t) {
  constexpr double kOffset = 0.008;
  const auto f = [](double time) {
    return std::pow(std::cos((time / kDiffusionTime + kOffset) / (1.0 + kOffset) * M_PI_2), 2);
  };
  return std::clamp(f(t) / f(0.0), 0.0, 1.0);
}

// x_u = estimate * x_0 + noisy * x_t + noise * e.
struct BackwardStep {
  double estimate = 0.0, noisy = 0.0, noise = 0.0;
};
inline BackwardStep StepBack(DiffusionSampler sampler, double t, double u) {
  const double a = SignalShare(t), b = SignalShare(u);
  if (u <= 0.0) return {1.0, 0.0, 0.0};
  switch (sampler) {
    case DiffusionSampler::kRenoised:
      return {std::sqrt(b), 0.0, std::sqrt(1.0 - b)};
    case DiffusionSampler::kDdpm: {
      const double left = (1.0 - b) / (1.0 - a), step = a / b;  // of x_u in x_t
      return {std::sqrt(b) * (1.0 - step) / (1.0 - a), std::sqrt(step) * left,
              std::sqrt(left * (1.0 - step))};
    }
  }
  return {};
}

// Past the frames of the longest motion learned from: steps fade until people rest, or the network
// alone goes on (as in SDM).
enum class Settling { kFade, kNone };
constexpr EnumNames<Settling, 2> Names(Settling) {
  return {{{"fade", Settling::kFade}, {"none", Settling::kNone}}};
}

struct DiffusionGeneratorOptions {
  DiffusionSampler sampler = DiffusionSampler::kRenoised;
  int steps = 25;
  int averaged = 8;         // samples of a forecast
  bool mirrored = true;     // every other one of them of the group in the mirror
  int learnt_frames = 128;  // of the longest motion learnt from; later ones settle
  Settling settle = Settling::kFade;
  double settling = 0.5;  // s, in which steps of later frames fade to 1/e
  double blend = 0.0;     // share of the way to the pendulum's hip
  PostprocessOptions postprocess = {true, 20};
  // Keeps what Forecast samples, for forecasts of the same people that differ by what is done to
  // samples afterwards (blend, postprocess).
  std::shared_ptr<std::vector<Trajectories>> sampled = nullptr;
};

class DiffusionGenerator : public MotionGenerator {
 public:
  // noise: makes a source that begins anew, for forecasts that repeat themselves; dt: s.
  DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members, double dt,
                     const DiffusionGeneratorOptions& options, std::function<NormalSource()> noise);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;

 private:
  // Everybody's motion, with what the network makes of the frames seen, before it is finished.
  std::vector<Trajectories> SampleWhole(const std::vector<ObservedMotion>& people,
                                        const DiffusionNetwork& network, int frames,
                                        const NormalSource& normal) const;
  // The mean of several.
  std::vector<Trajectories> SampledMean(const std::vector<ObservedMotion>& people,
                                        int frames) const;
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
