// models: what all restorations share, and the rigid one.
#include "models/restoration/restoration.h"

#include <algorithm>

namespace pushid {

Vector3<double> TipAt(const RestorationInput& person, int frame) {
  return HipPosition(person.body, person.q[frame]);
}

Vector4<double> TurnedPendulum(const Vector4<double>& q, double angle) {
  const Eigen::Matrix3d turn = TurnAboutZ(angle);
  const Eigen::Vector3d cart = turn * Eigen::Vector3d(q[0], q[1], 0.0);
  const Eigen::Vector3d rod =
      turn * Eigen::Vector3d(std::sin(q[2]), -std::cos(q[2]) * std::sin(q[3]),
                             std::cos(q[2]) * std::cos(q[3]));
  return {cart.x(), cart.y(), std::asin(std::clamp(rod.x(), -1.0, 1.0)),
          std::atan2(-rod.y(), rod.z())};
}

RestorationInput Mirrored(const RestorationInput& person) {
  RestorationInput mirrored = person;
  mirrored.first_pose = Mirrored(person.first_pose);
  for (Pose& pose : mirrored.seen) pose = Mirrored(pose);
  for (Vector4<double>& q : mirrored.q) q[1] = -q[1], q[3] = -q[3];
  return mirrored;
}

std::vector<BodyMotion> RigidRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  std::vector<BodyMotion> motions;
  for (const RestorationInput& person : people) {
    BodyMotion motion;
    for (int t = 0; t < static_cast<int>(person.q.size()); ++t) {
      const Eigen::Vector3d move = TipAt(person, t) - person.first_pose.col(0);
      motion.push_back(person.first_pose.colwise() + move);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

}  // namespace pushid
