// models: crowds: people in formations, and many people stepped on together.
//
// Crowd keeps no path: the same equations as Rollout, for any size and with threads over people.
//
//   Crowd crowd(scene, options, {parameters}, num_threads);
//   for (int t = 0; t < frames; ++t) {
//     if (!crowd.Advance().ok) ...
//   }
// Every person adds up what the neighbours do in canonical order (neighbours.h), so the result is
// the same to the last bit for any number of threads, and that of Rollout. One thread asks every
// pair once; several ask it for each of the two, so that no thread waits for another.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/enum_names.h"
#include "models/rollout.h"
#include "models/scene.h"

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

// People standing in a line, a diamond or a grid, all upright and alike, and the pushes
// that travel through them.
//
// Pushes go along +x, so people are numbered from the back (smallest x) forwards, and within a row
// from the right (smallest y) to the left: person 0 is the one, or among the ones, pushed first.
// The formation is centred on y = 0 as a whole (a last row that is not full stands to the right);
// the first row stands at x = 0.

enum class FormationShape {
  kLine,     // one behind the other
  kDiamond,  // a square lattice turned on its corner: rows of 1, 3, 5, 3, 1 for 13 people
  kGrid      // near-square: as many rows as people in a row, or one fewer
};
constexpr EnumNames<FormationShape, 3> Names(FormationShape) {
  return {{{"line", FormationShape::kLine},
           {"diamond", FormationShape::kDiamond},
           {"grid", FormationShape::kGrid}}};
}

// Cart positions (x, y), m. Neighbours stand `spacing` apart. A diamond is whole for 1, 5, 13, 25,
// 41 ... people; in between its outermost ring is filled from the corners on the x axis outwards.
std::vector<Eigen::Vector2d> FormationPositions(FormationShape shape, int people, double spacing);

// Everybody upright, at rest, with the same body.
Scene FormationScene(const std::vector<Eigen::Vector2d>& positions, const Body& body, double dt);

// A half-sine at the hip.
struct HipPush {
  double impulse = 0.0;    // N s
  double start = 0.0;      // s
  double duration = 0.2;   // s
  double direction = 0.0;  // rad from +x, positive to the left
};

// Start and duration are rounded to frames; the impulse is kept.
void AddHipPush(int person, const HipPush& push, Scene* scene);

}  // namespace pushid
