// models: many people stepped on together, without keeping the path: the same equations as
// Rollout, for crowds of any size and with threads over people.
//
//   Crowd crowd(scene, options, {parameters}, num_threads);
//   for (int t = 0; t < frames; ++t) {
//     if (!crowd.Advance().ok) ...
//   }
// Every person adds up what the neighbours do in canonical order (neighbours.h), so the result is
// the same to the last bit for any number of threads, and that of Rollout. One thread asks every
// pair once; several ask it for each of the two, so that no thread waits for another.
#pragma once

#include <vector>

#include "models/rollout.h"

namespace pushid {

class Crowd {
 public:
  // scene and options are copied; parameters: one set for everybody, or one per person.
  Crowd(Scene scene, const ModelOptions& options, std::vector<ParameterSet<double>> parameters,
        int num_threads);
  // forces_ points into the members.
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  // One frame on. Names the first person (in the scene's order) who leaves the model's domain;
  // the crowd stays at the frame before, and further calls say the same.
  RolloutStatus Advance();

  int frame() const { return frame_; }
  const std::vector<PendulumState<double>>& states() const { return now_; }
  const Scene& scene() const { return scene_; }

 private:
  void Advance(int person);

  Scene scene_;
  ModelOptions options_;
  std::vector<ParameterSet<double>> parameters_;
  int num_threads_;
  SceneForces<double> forces_;
  int frame_ = 0;
  RolloutStatus status_;
  std::vector<PendulumState<double>> before_, now_, next_;
};

}  // namespace pushid
