// models: windows drawn from motions, as LibTorch wants them. Included by *_torch.cc files alone.
#pragma once

#include "models/generators/particle_module_torch.h"

namespace pushid {

class ParticleWindows {
 public:
  ParticleWindows(const ParticleLayout& layout, const std::vector<LearntParticles>& motions,
                  const ParticleTrainingOptions& options);

  int num_windows() const { return static_cast<int>(all_.size()); }
  // Drawn by group, window and side.
  ParticleBatch Draw() const;
  // At most `most` of all windows, evenly taken, none in the mirror.
  ParticleBatch Some(int most) const;

 private:
  struct Place {
    int64_t row, last_row;  // where the window begins, where its motion ends
  };
  ParticleBatch Gather(const std::vector<Place>& places) const;

  const ParticleTrainingOptions& options_;
  torch::Tensor frames_, controls_;  // of all motions below one another, then of all mirrored
  int64_t mirrored_rows_ = 0;        // where the mirrored begin
  std::vector<Place> all_;
  std::vector<std::vector<Place>> by_group_;
  std::vector<double> group_share_;  // summed up
};

// Means and spreads of poses and displacements, over the motions and their mirror images.
ParticleNetwork ParticleStatistics(const ParticleLayout& layout,
                                   const std::vector<LearntParticles>& motions,
                                   const ParticleTrainingOptions& options);

}  // namespace pushid
