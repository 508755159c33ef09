// models: several particle networks of different seeds, averaged, blended with the linear forecast,
// and brought back to the person's bones.
//
// A sampled future is a sampled path of one member, the members taking turns, with a draw of the
// pose's jitter, moved by what the blend differs from the members' mean: so futures spread around
// the forecast as noise, members and what is not known of the pose do.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/generators/particle_network.h"
#include "models/generators/ridge_forecast.h"

namespace pushid {

struct ParticleGeneratorOptions {
  double ridge_share = 0.3;   // of the linear forecast in the blend; 0 needs none
  bool project_bones = true;  // to the lengths of the last frame that was seen
  double jitter = 0.7;        // of the pose in sampled futures; as the members were trained
  // Of the noise of sampled futures: e_t = memory e_{t-1} + sqrt(1 - memory^2) N(0, 1), times
  // scale. Both were chosen on the validation split, where the noise that was learned, drawn anew
  // every frame, covers 80 ms but too little of 1000 ms: errors of a forecast last.
  double noise_memory = 0.2, noise_scale = 1.0;
};

class ParticleGenerator : public MotionGenerator {
 public:
  ParticleGenerator(ParticleLayout layout, std::vector<ParticleNetwork> members,
                    RidgeForecast ridge, const ParticleGeneratorOptions& options);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource& normal) const override;
  // Of the first member, told the pose as it is.
  std::vector<SampledFuture> Driven(const ObservedMotion& person, int frames,
                                    const Eigen::MatrixXf& noise) const override;

 private:
  // What the members forecast in the mean, without bones.
  std::vector<Trajectories> MeanOfMembers(const std::vector<ObservedMotion>& people,
                                          int frames) const;
  void Blend(const std::vector<ObservedMotion>& people, std::vector<Trajectories>* motions) const;
  void Finish(const ObservedMotion& person, Trajectories* motion) const;

  ParticleLayout layout_;
  std::vector<ParticleNetwork> members_;
  RidgeForecast ridge_;
  ParticleGeneratorOptions options_;
};

}  // namespace pushid
