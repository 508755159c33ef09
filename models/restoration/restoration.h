// models: from a pendulum's path to the motion of a whole body.
//
//   RestorationInput person = {first_pose, body, q, dt, push_start};
//   std::vector<BodyMotion> bodies = restoration.Restore({person});
//   Finish(person, PostprocessOptions(), &bodies[0]);           // postprocess.h
//
// All that a restoration knows of a person is the pose at frame 0, mass, rod length and what its
// view names (restoration_view.h): the pendulum's path, those of the neighbours too, or, to compare
// with, no pendulum at all. The order of people changes nothing. Every kind turns a person to the
// heading at frame 0 first and back at the end.
#pragma once

#include <string_view>
#include <vector>

#include "models/restoration/body.h"
#include "models/restoration/restoration_kind.h"

namespace pushid {

// What is pushed from outside: all that a restoration without pendulums is told of the motion.
struct SeenPush {
  Vector3<double> velocity =
      Vector3<double>::Zero();                      // m/s: impulse over the mass of who is pushed
  double duration = 0.0;                            // s, of the longest push
  Vector3<double> place = Vector3<double>::Zero();  // m: hip of who is pushed, at frame 0
};

struct RestorationInput {
  Pose first_pose;                 // m, world
  Body body;                       // mass, rod length and cart height
  std::vector<Vector4<double>> q;  // the pendulum, frame by frame; at least one
  double dt = 1.0 / 60.0;          // s
  double push_start = 0.0;         // s, of the first push on anybody
  SeenPush push = {};
  // Frame by frame, whether the feet stand; empty: the model says nothing of them.
  std::vector<bool> stands = {};
  // Poses of the first frames, first_pose among them, where more than that was seen.
  std::vector<Pose> seen = {};

  // The last frame that was seen.
  int Now() const { return seen.empty() ? 0 : static_cast<int>(seen.size()) - 1; }
};

class Restoration {
 public:
  virtual ~Restoration() = default;
  virtual std::string_view kind() const = 0;  // its name
  // Bare motions, one per person with as many frames as q has; without post-processing.
  virtual std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const = 0;
};

// The first pose carried along by the rod's tip: what any network has to beat.
class RigidRestoration : public Restoration {
 public:
  std::string_view kind() const override { return Name(RestorationKind::kRigid); }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
};

// The tip of the rod, where the hip goes.
Vector3<double> TipAt(const RestorationInput& person, int frame);

// A pendulum turned about z: the cart's place and the rod's direction are.
Vector4<double> TurnedPendulum(const Vector4<double>& q, double angle);

// A pendulum's path in the frame of a heading, with its rates, read at any frame; beyond its ends
// the ends are seen.
class TurnedPath {
 public:
  TurnedPath(const RestorationInput& person, double heading);
  const Vector4<double>& First() const { return q_.front(); }
  Vector4<double> At(double frame) const { return Read(q_, frame); }
  Vector4<double> RateAt(double frame) const { return Read(rate_, frame); }

 private:
  static Vector4<double> Read(const std::vector<Vector4<double>>& values, double frame);
  std::vector<Vector4<double>> q_, rate_;
};

// The same person in the mirror plane y = 0.
RestorationInput Mirrored(const RestorationInput& person);

}  // namespace pushid
