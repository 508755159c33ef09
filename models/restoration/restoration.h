// models: from a pendulum's path to the motion of a whole body.
//
//   RestorationInput person = {first_pose, body, q, dt, push_start};
//   std::vector<BodyMotion> bodies = restoration.Restore({person});
//   Finish(person, PostprocessOptions(), &bodies[0]);           // postprocess.h
//
// All that a restoration knows of a person is the pose at frame 0, mass, rod length and the
// pendulum's path; people do not see each other, so their order changes nothing. Every kind turns a
// person to the heading at frame 0 first and back at the end.
#pragma once

#include <string_view>
#include <vector>

#include "models/restoration/body.h"
#include "models/restoration/restoration_kind.h"

namespace pushid {

struct RestorationInput {
  Pose first_pose;                 // m, world
  Body body;                       // mass, rod length and cart height
  std::vector<Vector4<double>> q;  // the pendulum, frame by frame; at least one
  double dt = 1.0 / 60.0;          // s
  double push_start = 0.0;         // s, of the first push on anybody
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

// The same person in the mirror plane y = 0.
RestorationInput Mirrored(const RestorationInput& person);

}  // namespace pushid
