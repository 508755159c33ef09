// models: several particle networks of different seeds, averaged, blended with the linear forecast,
// and brought back to the person's bones.
//
// A sampled future is a sampled path of one member, the members taking turns, moved by what the
// blend differs from the members' mean: so futures spread as noise and members do, around the
// forecast.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/generators/particle_network.h"
#include "models/generators/ridge_forecast.h"

namespace pushid {

struct ParticleGeneratorOptions {
  double ridge_share = 0.3;   // of the linear forecast in the blend; 0 needs none
  bool project_bones = true;  // to the lengths of the last frame that was seen
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
