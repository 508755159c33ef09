// models: learned generators of motion: from what was seen of people to what they do next.
//
//   std::vector<Trajectories> next = generator.Forecast(people, 25);
//   auto futures = generator.Sample(people, 25, 20, normal);   // 20 futures of each person
//
// All people of a call have been seen for the same number of frames. A kind that lets people see
// each other takes those of one call for a group; particles do not see each other, so that any
// windows may be forecast together, which is faster.
#pragma once

#include <vector>

#include "models/particles.h"
#include "models/process_noise.h"

namespace pushid {

// The seen motion of a person, and what acts on them.
struct ObservedMotion {
  Trajectories frames;
  Eigen::MatrixXf controls = {};  // a column per frame, observed and to come; or empty
  // For people who see each other, and for physics beside them.
  Eigen::Vector2f place = Eigen::Vector2f::Zero();  // of the frames' origin, m, world
  float mass = 0.0f;                                // kg
  Eigen::MatrixXf pendulum = {};  // where physics have the hip, as in frames; or empty
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
  // [person][future]; nobody's where a kind samples none.
  virtual std::vector<std::vector<SampledFuture>> Sample(
      const std::vector<ObservedMotion>& /*people*/, int /*frames*/, int /*count*/,
      const NormalSource& /*normal*/) const {
    return {};
  }
};

}  // namespace pushid
