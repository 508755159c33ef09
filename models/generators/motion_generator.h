// models: learned generators of motion, which continue the observed motion of people.
//
//   std::vector<Trajectories> next = generator.Forecast(people, 25);
//   auto futures = generator.Sample(people, 25, 20, normal);   // 20 futures of each person
//
// All people of one call have the same number of observed frames. A kind whose people interact
// treats the people of one call as a group. Particles do not interact, so any windows may be
// forecast in one call, which is faster.
#pragma once

#include <vector>

#include "models/particles.h"
#include "models/process_noise.h"

namespace pushid {

// The observed motion of a person, and the push that acts on them.
struct ObservedMotion {
  Trajectories frames;
  Eigen::MatrixXf controls = {};  // a column per frame, observed and to come; or empty
  // Used only by kinds whose people interact, and for blending with physics.
  Eigen::Vector2f place = Eigen::Vector2f::Zero();  // of the frames' origin, m, world
  float mass = 0.0f;                                // kg
  Eigen::MatrixXf pendulum = {};  // the hip as predicted by physics, rows as in frames; or empty
};

struct SampledFuture {
  Trajectories motion;
  double log_likelihood = 0.0;  // of its transitions; comparable between futures of one person
};

class MotionGenerator {
 public:
  virtual ~MotionGenerator() = default;
  virtual const ParticleLayout& layout() const = 0;
  virtual std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                             int frames) const = 0;
  // Sampled futures, [person][future]; empty for kinds that do not sample.
  virtual std::vector<std::vector<SampledFuture>> Sample(
      const std::vector<ObservedMotion>& /*people*/, int /*frames*/, int /*count*/,
      const NormalSource& /*normal*/) const {
    return {};
  }
};

}  // namespace pushid
