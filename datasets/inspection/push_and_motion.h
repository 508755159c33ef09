// datasets: a push beside the motion that it made: direction, size, time, zero.
//
// The point p = 0.9 hip + 0.1 midpoint of the ankles carries a person's mass M. Whoever is pushed
// by a force F goes, at first, along F and at no more than
//   v = J / M,   J = int F dt,
// people who stand as well as those who step: they lose speed to the ground (0.3 to 1.1 J / M was
// simulated), and never gain any. So only the first motion is looked at:
//   onset: p is farther from where it rested than noise and sway go (1 cm at least), and as fast as
//   a quarter of the largest speed; its direction then, and the time by which F alone would have
//   brought it there;
//   gain: the largest speed along J over J / M.
// A net push is the beginning of a push; what it gains is counted while it lasts.
//
// Rejected: the best lag of F's double integral, with drag and stiffness as nuisances: on two-link
// people who stand it was off by 0.1 to 0.3 s, and its gain 0.2.
//
// False alarms of what is found by it: ident/push/README.md.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/manifest/body_roles.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

struct PushAndMotion {
  double speed = 0.0;  // m/s: J / M of the push, with those that overlap it
  // Largest speed along the push over that, and its range: three standard errors of the markers'
  // noise either way.
  double gain = 1.0, least_gain = 1.0, largest_gain = 1.0;
  std::optional<double> angle;  // rad, of the first motion from the push; none: nobody moves
  // s by which the motion starts before (the push is late) or behind the time at which it could:
  // beyond what people's different reactions explain; 0: none.
  double push_late = 0.0, push_early = 0.0;
};

// Of the first push on a person. None: nobody pushes, the force has no horizontal impulse, or
// frames around it were not seen.
std::optional<PushAndMotion> ComparePush(const PendulumRecording& recording, int person);

// What a measured force reads where nobody pulls, N, horizontal: the mean of its last 0.2 s, where
// that is steady and small beside the peak but no noise about zero. 0: none.
double RestingForce(const ScenePush& push, double dt);

// Whether a measured force stops, or the recording does, while it is large.
bool HasNoEnd(const ScenePush& push, int num_frames);

// Where a person faces in the file's axes, and the steps of their feet.

// The axis that a direction is nearest to.
inline int LargestAxis(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

// "-y": the same with its sign.
inline std::string AxisName(const Eigen::Vector3d& direction) {
  const int axis = LargestAxis(direction);
  return std::string(direction[axis] < 0.0 ? "-" : "") + "xyz"[axis];
}

// Two points of the pelvis, one on each side, as indices; empty where there are none.
struct PelvisSides {
  std::vector<int> left{}, right{};
  bool known() const { return !left.empty() && !right.empty(); }
};
// The anterior iliac spines, or the hip joints, where the file has them itself.
PelvisSides SidesOf(const Result<BodyRoles>& roles);

struct Facing {
  Eigen::Vector3d to_the_left = Eigen::Vector3d::Zero();
  std::string by;     // "the pelvis", "the ankles"
  std::string doubt;  // empty: none
};

// By the pelvis at frame `first`; without one by the line between the ankles, meant over
// a second, as one foot is ahead in mid-stride. Doubtful where that line turns, or where the person
// walks to its side. rod: from ankles to hip; metres: of the file's unit.
Facing FacingOf(const PointMotion& motion, const PelvisSides& pelvis,
                const std::vector<Eigen::Vector3d>& hip, const std::vector<Eigen::Vector3d>& left,
                const std::vector<Eigen::Vector3d>& right, const Eigen::Vector3d& rod, int first,
                double metres);

// Points of a motion file with their gaps, and the steps of the feet among them.

// Frames in which all of the chosen points were seen have their mean, others NaN.
std::vector<Eigen::Vector3d> MeanOf(const PointMotion& motion, const std::vector<int>& chosen);

// Frames on end in which one of the chosen points was not seen.
int LongestHidden(const PointMotion& motion, const std::vector<int>& chosen);

// `to_project` takes the file's coordinates to metres, z up, x where the person faces.
PersonSteps StepsOf(const PointMotion& motion, const PendulumJoints& joints,
                    const Eigen::Matrix3d& to_project);

}  // namespace pushid
