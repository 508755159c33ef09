// models: from a pendulum's path to the motion of a whole body.
//
//   RestorationInput person = {first_pose, body, q, dt, push_start};
//   std::vector<BodyMotion> bodies = restoration.Restore({person});
//   Finish(person, PostprocessOptions(), &bodies[0]);           // postprocess.h
//
// The inputs of a restoration are the pose at frame 0, mass, rod length and what its view selects
// (RestorationView): the pendulum's path, also those of the neighbours, or, for comparison, no
// pendulum. The order of people does not matter. Every kind works in the frame of the heading at
// frame 0.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/enum_names.h"
#include "models/restoration/body.h"
#include "models/scene.h"

namespace pushid {

// The kinds of restoration, one row each.
//
// A new kind is a value and a row here, and a row in ident/bodies/restoration_files.h, which names
// the functions that make it from a file and train it.

enum class RestorationKind { kRigid, kWindow, kCvae };

struct RestorationKindRow {
  const char* name;  // in files and on the command line
  RestorationKind value;
  const char* what;      // for the list of kinds on the command line
  bool trained;          // it has weights, in a folder
  bool sees_neighbours;  // it has RestorationView::kNeighbours
};

inline constexpr RestorationKindRow kRestorationKinds[] = {
    {"rigid", RestorationKind::kRigid, "the first pose carried by the rod's tip", false, false},
    {"window", RestorationKind::kWindow, "fast, default", true, true},
    {"cvae", RestorationKind::kCvae, "LDP's chain", true, false},
};
constexpr const auto& Names(RestorationKind) { return kRestorationKinds; }
static_assert(RowsAreInOrder(kRestorationKinds), "RowOf finds a row by its value");

// The inputs of a restoration besides the first pose, mass and size.
enum class RestorationView {
  kPendulum,    // the person's own pendulum
  kNeighbours,  // also those of the neighbours, for kinds with sees_neighbours
  kPose         // no pendulum, for ablations: `window` has the push, `cvae` the previous pose
};
constexpr EnumNames<RestorationView, 3> Names(RestorationView) {
  return {{{"pendulum", RestorationView::kPendulum},
           {"neighbours", RestorationView::kNeighbours},
           {"pose", RestorationView::kPose}}};
}

// The external push, an input of `window` with RestorationView::kPose.
struct SeenPush {
  Vector3<double> velocity = Vector3<double>::Zero();  // m/s: impulse over the pushed person's mass
  double duration = 0.0;                               // s, of the longest push
  Vector3<double> place = Vector3<double>::Zero();     // m: the pushed person's hip at frame 0
};

// The feet that a model predicts, right and left.
struct FootPath {
  Eigen::Vector2d moved[2];  // m, since frame 0
  bool flies[2];             // off the ground
};

struct RestorationInput {
  Pose first_pose;                 // m, world
  Body body;                       // mass, rod length and cart height, at frame 0
  std::vector<Vector4<double>> q;  // the pendulum, frame by frame; at least one
  double dt = 1.0 / 60.0;          // s
  double push_start = 0.0;         // s, of the first push on anybody
  SeenPush push = {};
  std::vector<FootPath> feet = {};  // frame by frame; empty: the model predicts none
  // Length of a moving rod and the cart's height at every frame of q, m; empty: those of body.
  std::vector<Eigen::Vector2d> lengths = {};
  // The observed poses, first_pose among them; empty: first_pose alone.
  std::vector<Pose> seen = {};

  Body BodyAt(int frame) const {
    if (lengths.empty()) return body;
    return {body.mass, lengths[frame][0], lengths[frame][1]};
  }
  // Appends a frame of a rollout.
  void Follow(const PendulumState<double>& state, bool rod_moves) {
    q.push_back(state.q);
    if (!rod_moves) return;
    const Body now = BodyNow(body, state.rod);
    lengths.emplace_back(now.rod_length, now.cart_height);
  }
  // The last observed frame.
  int Now() const { return seen.empty() ? 0 : static_cast<int>(seen.size()) - 1; }
};

class Restoration {
 public:
  virtual ~Restoration() = default;
  virtual std::string_view kind() const = 0;
  // Motions before post-processing, one per person, each with as many frames as q.
  virtual std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const = 0;
};

// The first pose moved with the rod's tip: the baseline of all networks.
class RigidRestoration : public Restoration {
 public:
  std::string_view kind() const override { return RowOf(RestorationKind::kRigid).name; }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
};

// The tip of the rod, which is the hip.
Vector3<double> TipAt(const RestorationInput& person, int frame);

// Turns a pendulum about z: the cart's place and the rod's direction.
Vector4<double> TurnedPendulum(const Vector4<double>& q, double angle);

// The value at any frame, by linear interpolation; the first or last value outside.
template <typename Value>
Value ReadAt(const std::vector<Value>& values, double frame) {
  const double at = std::clamp(frame, 0.0, static_cast<double>(values.size() - 1));
  const size_t low = static_cast<size_t>(at), high = std::min(low + 1, values.size() - 1);
  const double share = at - static_cast<double>(low);
  if (share == 0.0) return values[low];
  return (1.0 - share) * values[low] + share * values[high];
}

// Values by frame with their rates, both interpolated by ReadAt.
template <typename Value>
class FramePath {
 public:
  FramePath(std::vector<Value> values, double dt) : values_(std::move(values)) {
    const int last = static_cast<int>(values_.size()) - 1;
    for (int t = 0; t <= last; ++t) {
      const int before = std::max(0, t - 1), after = std::min(last, t + 1);
      rates_.push_back((values_[after] - values_[before]) / (std::max(1, after - before) * dt));
    }
  }
  int num_frames() const { return static_cast<int>(values_.size()); }
  const Value& First() const { return values_.front(); }
  Value At(double frame) const { return ReadAt(values_, frame); }
  Value RateAt(double frame) const { return ReadAt(rates_, frame); }

 private:
  std::vector<Value> values_, rates_;
};

// The person's pendulum in the frame of a heading.
FramePath<Vector4<double>> TurnedPath(const RestorationInput& person, double heading);

// The people of a scene without pendulums: q is empty.
std::vector<RestorationInput> PeopleOf(const Scene& scene, const std::vector<Pose>& first_poses);

// Mirrored in the plane y = 0.
RestorationInput Mirrored(const RestorationInput& person);

}  // namespace pushid
